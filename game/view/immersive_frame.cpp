#include "game/view/immersive_frame.hpp"

namespace bolt::view {

EyeGroup eye_group(const xr::HeadView& view, VkExtent2D size) {
    EyeGroup group{size, {}};
    for (const xr::EyeView& eye : view.eyes)
        group.eyes.push_back(render::make_eye(eye.pose,
                                              {eye.fov.left, eye.fov.right, eye.fov.up, eye.fov.down},
                                              immersive_range.near, immersive_range.far));
    return group;
}

// The largest rectangle of this shape in the middle of `whole`.
static VkRect2D inscribed(VkExtent2D shape, VkExtent2D whole) {
    const std::uint64_t width = whole.width, height = whole.height;
    VkExtent2D part = whole;
    if (shape.width == 0 || shape.height == 0) return {{0, 0}, part};
    if (width * shape.height > height * shape.width)
        part.width = static_cast<std::uint32_t>(height * shape.width / shape.height);
    else
        part.height = static_cast<std::uint32_t>(width * shape.height / shape.width);
    return {{static_cast<std::int32_t>((whole.width - part.width) / 2),
             static_cast<std::int32_t>((whole.height - part.height) / 2)},
            part};
}

VkRect2D filling_part(VkExtent2D picture, VkExtent2D window) { return inscribed(window, picture); }

VkRect2D fitted(VkExtent2D picture, VkExtent2D window) { return inscribed(picture, window); }

}  // namespace bolt::view
