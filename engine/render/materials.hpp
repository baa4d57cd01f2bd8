// Converts materials and textures to the shaders' layout.
#pragma once

#include "engine/render/gpu_model.hpp"

namespace bolt::render {

shared::Material make_material(const assets::Material& material);
// SCENE_… bits that the material needs.
std::uint32_t features_of(const assets::Material& material);
MaterialMaps maps_of(const assets::Material& material);

// Uploads all textures of the materials with mips; colours as sRGB, other maps as linear values.
Result<std::vector<GpuTexture>> upload_textures(gpu::Device& device, const assets::Model& model);

// Creates a texture of one texel.
Result<GpuTexture> plain_texture(gpu::Device& device, const std::array<std::uint8_t, 4>& texel);

}  // namespace bolt::render
