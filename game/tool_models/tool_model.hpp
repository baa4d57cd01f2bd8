// Models of tools that are generated from parameters: no file is needed, and the same parameters give the
// same bytes. Frame: that of parameters.hpp.
#pragma once

#include <string>

#include "content/format/assembly.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "game/tool_models/parameters.hpp"

namespace bolt::tool_models {

// The model for pictures: a node for each part, with normals and materials.
// `completed`: parameters as completed() or parameters_of() return them.
assets::Model drawn_model(const ToolParameters& completed);

// The model for contact: closed meshes without normals and materials, a node for each, with fewer triangles.
assets::Model contact_model(const ToolParameters& completed);

// The tool of an assembly: an open-end wrench or a click torque wrench with its dimensions. Every design
// that the assembly's reader accepts has one.
ToolParameters parameters_of(const content::WrenchDesign& design);

// Names a generated contact model in the session file: the description of the tool, and size and checksum
// (FNV-1a, 64 bits) of the model's bytes.
Result<std::string> identity_of(const ToolParameters& completed);

}  // namespace bolt::tool_models
