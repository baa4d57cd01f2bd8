// Converts the sections of a validated document to a Model.
#pragma once

#include "engine/assets/model.hpp"
#include "engine/assets/read/document.hpp"

namespace bolt::assets {

Status read_meshes(Document& document, Model& model);
Status read_materials(const Document& document, Model& model);
Status read_textures(Document& document, Model& model);
Status read_nodes(const Document& document, Model& model);
Status read_skins(Document& document, Model& model);
Status read_animations(Document& document, Model& model);
Status read_cameras(const Document& document, Model& model);
Status read_lights(const Document& document, Model& model);

}  // namespace bolt::assets
