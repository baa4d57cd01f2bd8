// Render targets of a picture's size, with one layer per view of a pass.
#pragma once

#include "engine/gpu/resources.hpp"

namespace bolt::render {

struct RenderTargets {
    // Four samples per pixel. The optional ones are created when a scene first needs them.
    gpu::Image depth;
    gpu::Image surfaces;                  // normal, material, grain (see shaders/surface.glsl)
    gpu::Image wide_colors, wide_roughs;  // optional: base colour and metallic; roughness and occlusion
    gpu::Image drawn;                     // optional: parts shaded while drawn
    gpu::Image over;                      // the same, resolved
    gpu::Image picture;                   // one sample
    gpu::Image kept_depth;                // optional: depth of the first sample, for readback
    gpu::Image marks;                     // optional: marks of outlined objects
    gpu::Image small_depth, raw_occlusion, occlusion;  // optional, half size
    VkExtent2D extent{};
    std::uint32_t layers = 1;
};

Result<RenderTargets> make_targets(gpu::Device& device, VkExtent2D extent, std::uint32_t layers);
Status add_wide_targets(gpu::Device& device, RenderTargets& targets);
Status add_forward_targets(gpu::Device& device, RenderTargets& targets);
Status add_mark_target(gpu::Device& device, RenderTargets& targets);
Status add_occlusion_targets(gpu::Device& device, RenderTargets& targets);
Status add_kept_depth(gpu::Device& device, RenderTargets& targets);

// One layer of an image: the picture of a view.
struct ImageLayer {
    const gpu::Image* image = nullptr;
    std::uint32_t layer = 0;
};

// The render targets of views of one size, kept from frame to frame.
struct ViewGroup {
    std::vector<RenderTargets> targets;  // one per pass
    VkExtent2D extent{};
    std::uint32_t views = 0, views_per_pass = 1;

    [[nodiscard]] ImageLayer picture(std::uint32_t view) const {
        return {&targets[view / views_per_pass].picture, view % views_per_pass};
    }
    [[nodiscard]] ImageLayer depth(std::uint32_t view) const {
        return {&targets[view / views_per_pass].kept_depth, view % views_per_pass};
    }
};

// Visits every image of the targets.
template <class Visit>
void each_image(RenderTargets& targets, const Visit& visit) {
    for (gpu::Image* image :
         {&targets.depth, &targets.surfaces, &targets.wide_colors, &targets.wide_roughs, &targets.drawn,
          &targets.over, &targets.picture, &targets.kept_depth, &targets.marks, &targets.small_depth,
          &targets.raw_occlusion, &targets.occlusion})
        visit(*image);
}

}  // namespace bolt::render
