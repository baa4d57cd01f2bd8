#include "game/view/immersion.hpp"

namespace bolt::view {

EyeGroup eye_group(const xr::HeadView& view, VkExtent2D size) {
    EyeGroup group{size, {}};
    for (const xr::EyeView& eye : view.eyes)
        group.eyes.push_back(render::make_eye(eye.pose,
                                              {eye.fov.left, eye.fov.right, eye.fov.up, eye.fov.down},
                                              immersive_range.near, immersive_range.far));
    return group;
}

VkRect2D filling_part(VkExtent2D picture, VkExtent2D window) {
    const std::uint64_t width = picture.width, height = picture.height;
    VkExtent2D part = picture;
    if (window.width == 0 || window.height == 0) return {{0, 0}, part};
    if (width * window.height > height * window.width)
        part.width = static_cast<std::uint32_t>(height * window.width / window.height);
    else
        part.height = static_cast<std::uint32_t>(width * window.height / window.width);
    return {{static_cast<std::int32_t>((picture.width - part.width) / 2),
             static_cast<std::int32_t>((picture.height - part.height) / 2)},
            part};
}

}  // namespace bolt::view
