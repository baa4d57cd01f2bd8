// Materials and textures as the shaders take them.
#pragma once

#include "engine/render/gpu_model.hpp"

namespace bolt::render {

shared::Material make_material(const assets::Material& material);
// SCENE_… bits of what the material needs of the shader.
std::uint32_t features_of(const assets::Material& material);
MaterialMaps maps_of(const assets::Material& material);

// All textures that the materials use, with mips; colours as sRGB, everything else linear.
Result<std::vector<GpuTexture>> upload_textures(gpu::Device& device, const assets::Model& model);

// A texture of one texel.
Result<GpuTexture> plain_texture(gpu::Device& device, const std::array<std::uint8_t, 4>& texel);

}  // namespace bolt::render
