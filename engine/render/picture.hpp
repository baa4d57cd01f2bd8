// A picture on the CPU: what offscreen rendering is for.
#pragma once

#include "engine/render/inset.hpp"

namespace bolt::render {

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // sRGB, rows from the top
};

// One picture for each eye.
Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets = {});

}  // namespace bolt::render
