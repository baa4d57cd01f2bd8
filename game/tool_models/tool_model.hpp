// Models of tools that are generated from parameters: no file is needed, and the same parameters give the
// same bytes. Frame: that of parameters.hpp.
#pragma once

#include <cstdint>
#include <string>

#include "content/format/assembly.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "game/tool_models/parameters.hpp"
#include "haptics/collision/tool_head.hpp"

namespace bolt::tool_models {

// The model for pictures: a node for each part, with normals and materials.
// `completed`: here and below, parameters with all defaults filled in, as completed() and parameters_of()
// return them.
assets::Model drawn_model(const ToolParameters& completed);

// The model for contact: closed meshes without normals and materials, a node for each, with fewer triangles.
assets::Model contact_model(const ToolParameters& completed);

// The parameters of a tool of an assembly, of any kind that an assembly may have. Every design that the
// assembly's reader accepts has parameters.
ToolParameters parameters_of(const content::WrenchDesign& design);

// The part of a tool that grips, for contacts and torque, and its direction relative to the handle.
struct GrippingHead {
    collision::ToolHead head;
    double head_angle = 0.0;       // rad, from the handle to the head (servo::Wrench::head_angle)
    double twist_stiffness = 0.0;  // N·m/rad, of its extension bar; 0: none
};

// Fails for tools that turn nothing by themselves, such as extension bars.
Result<GrippingHead> gripping_head(const ToolParameters& completed);

// The same for the tool of an assembly, whose model may be an author's.
GrippingHead gripping_head(const content::WrenchDesign& design);

// The test torque of a tool, or that of its square drive if the drive bears less.
struct ToolStrength {
    TestTorque limit;
    bool of_drive = false;  // `limit` is that of the drive
    double drive = 0.0;     // m, width of that drive
};
ToolStrength strength_of(const ToolParameters& tool);
ToolStrength strength_of(const content::WrenchDesign& design);

// The rule for the torque at which a key or bit with the width s across flats begins to bend for good.
//   measured     0.857 of the torque at which it breaks: 1.02 / 1.19 N·m, the yield and breaking torques of
//                a key of 1.5 mm (Unbrako after ANSI B18.3.2M). It breaks at 0.2 R_m s³ (Bondhus; R_m = 1.47
//                GPa at 45 HRC)
//   first_yield  the torque at which the middle of its flats yields: W_t τ with W_t = 0.188 s³ (Dubbel) and
//                τ = 750 MPa. Sessions of format 8 were recorded with this rule
enum class KeyStrength : std::uint8_t { measured, first_yield };

// N·m at which a hexagon key or bit of this width across flats (m) begins to bend for good.
double key_yield_torque(double across_flats, KeyStrength keys = KeyStrength::measured);

// N·m at which a tool begins to bend for good; 0: unknown. ISO 1711-1 only says that it does not bend at its
// test torque; the value, 1.2 times the test torque, is our choice. Hexagon keys and bits bend at
// key_yield_torque() if that is less.
double yield_torque(const content::WrenchDesign& design, KeyStrength keys = KeyStrength::measured);

// N·m that a tool bears: its test torque, or that of its square drive. No test torque of keys and bits is
// known: they bear the torque at which they begin to bend. 0: unknown.
double bearable_torque(const content::WrenchDesign& design);

// The text that names a generated contact model in the session file: the description of the tool, and size
// and checksum (FNV-1a, 64 bits) of the model's bytes. Fails if the model cannot be written.
Result<std::string> identity_of(const ToolParameters& completed);

}  // namespace bolt::tool_models
