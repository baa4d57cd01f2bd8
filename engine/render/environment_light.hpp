// Image-based lighting, prefiltered and uploaded to the GPU.
#pragma once

#include "engine/gpu/resources.hpp"
#include "engine/shading/prefilter.hpp"

namespace bolt::render {

struct EnvironmentLight {
    gpu::Image levels;  // specular mips, from sharp to rough
    shading::Harmonics diffuse{};
};

Result<EnvironmentLight> upload_environment(gpu::Device& device, const shading::RadianceImage& image,
                                            std::uint32_t size = 128);

// Uploads the table of directional albedos (engine/shading/albedo.hpp): columns √cos, rows roughness.
Result<gpu::Image> upload_albedo_table(gpu::Device& device);

}  // namespace bolt::render
