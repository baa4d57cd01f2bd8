// Images as large as a picture, with a layer for each view that is drawn in the same pass.
#pragma once

#include "engine/gpu/resources.hpp"

namespace bolt::render {

struct Targets {
    // Four samples a pixel. The wide ones are made when a scene asks for them.
    gpu::Image depth;
    gpu::Image surfaces;                  // normal, material, grain (shaders/surface.glsl)
    gpu::Image wide_colors, wide_roughs;  // base colour and metallic; roughness and occlusion
    gpu::Image drawn;                     // lit as it is drawn; made when a scene asks for it
    gpu::Image over;                      // the same, one sample
    gpu::Image picture;                   // one sample
    gpu::Image kept_depth;                // of the first sample; made when it is to be read back
    gpu::Image marks;                     // of what has an outline; made when a scene asks for it
    gpu::Image small_depth, raw_occlusion, occlusion;  // half the size; made when a scene asks for them
    VkExtent2D extent{};
    std::uint32_t layers = 1;
};

Result<Targets> make_targets(gpu::Device& device, VkExtent2D extent, std::uint32_t layers);
Status add_wide_targets(gpu::Device& device, Targets& targets);
Status add_forward_targets(gpu::Device& device, Targets& targets);
Status add_mark_target(gpu::Device& device, Targets& targets);
Status add_occlusion_targets(gpu::Device& device, Targets& targets);
Status add_kept_depth(gpu::Device& device, Targets& targets);

// Where a view's picture is.
struct Layer {
    const gpu::Image* image = nullptr;
    std::uint32_t layer = 0;
};

// What views of one size are drawn into, kept from frame to frame.
struct ViewGroup {
    std::vector<Targets> targets;  // one a pass
    VkExtent2D extent{};
    std::uint32_t views = 0, views_a_pass = 1;

    [[nodiscard]] Layer picture(std::uint32_t view) const {
        return {&targets[view / views_a_pass].picture, view % views_a_pass};
    }
    [[nodiscard]] Layer depth(std::uint32_t view) const {
        return {&targets[view / views_a_pass].kept_depth, view % views_a_pass};
    }
};

// Visits every image of them.
template <class Visit>
void each_image(Targets& targets, const Visit& visit) {
    for (gpu::Image* image :
         {&targets.depth, &targets.surfaces, &targets.wide_colors, &targets.wide_roughs, &targets.drawn,
          &targets.over, &targets.picture, &targets.kept_depth, &targets.marks, &targets.small_depth,
          &targets.raw_occlusion, &targets.occlusion})
        visit(*image);
}

}  // namespace bolt::render
