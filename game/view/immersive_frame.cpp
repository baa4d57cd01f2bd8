#include "game/view/immersive_frame.hpp"

#include <cmath>

namespace bolt::view {

// The corners of the hidden area in the picture, as render::Eye has them.
static std::shared_ptr<const std::vector<glm::vec2>> in_picture(const xr::EyeView& eye) {
    if (eye.hidden == nullptr) return nullptr;
    const auto f = [](double angle) { return static_cast<float>(std::tan(angle)); };
    const glm::vec2 upper_left(f(eye.fov.left), f(eye.fov.up)),
        lower_right(f(eye.fov.right), f(eye.fov.down));
    auto corners = std::make_shared<std::vector<glm::vec2>>();
    corners->reserve(eye.hidden->size());
    for (const glm::vec2& corner : *eye.hidden)
        corners->push_back(2.0F * (corner - upper_left) / (lower_right - upper_left) - 1.0F);
    return corners;
}

EyeGroup eye_group(const xr::HeadView& view, VkExtent2D size) {
    EyeGroup group{size, {}};
    for (const xr::EyeView& eye : view.eyes) {
        group.eyes.push_back(render::make_eye(eye.pose,
                                              {eye.fov.left, eye.fov.right, eye.fov.up, eye.fov.down},
                                              immersive_range.near, immersive_range.far));
        group.eyes.back().hidden = in_picture(eye);
    }
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

std::vector<gpu::ShownPicture> mirror_pictures(Mirror mirror, const MirrorSources& sources,
                                               VkExtent2D window) {
    const auto eye = [&](std::size_t number, const VkRect2D& place) {
        const render::ImageLayer& picture = sources.eyes[number];
        return gpu::ShownPicture{picture.image, picture.layer, filling_part(sources.eye_size, place.extent),
                                 place};
    };
    const bool two_eyes = sources.eyes.size() > 1;
    const bool halves = window.width > 1 && ((mirror == Mirror::both_eyes && two_eyes) ||
                                             (mirror == Mirror::panel && sources.panel));
    if (!halves) return {eye(mirror == Mirror::right_eye && two_eyes ? 1 : 0, {{0, 0}, window})};
    const std::uint32_t half = window.width / 2;
    const VkRect2D left{{0, 0}, {half, window.height}};
    const VkExtent2D right{window.width - half, window.height};
    if (mirror == Mirror::both_eyes)
        return {eye(0, left), eye(1, {{static_cast<std::int32_t>(half), 0}, right})};
    VkRect2D panel = fitted(sources.panel_size, right);
    panel.offset.x += static_cast<std::int32_t>(half);
    return {eye(0, left), {sources.panel->image, sources.panel->layer, {}, panel}};
}

ImmersiveFrame immersive_frame(xr::Headset& headset, const xr::HeadsetFrame& frame) {
    ImmersiveFrame immersive;
    immersive.head = frame.view.head;
    immersive.tracked = frame.view.tracked;
    immersive.attentive = frame.focused;
    for (const xr::SessionEvent& event : frame.events) {
        const auto* recentred = std::get_if<xr::Recentred>(&event);
        if (recentred == nullptr) continue;
        immersive.recentred = true;
        immersive.origin_moved = immersive.origin_moved || recentred->base;
    }
    immersive.floor_known = headset.session().base_space() != xr::BaseSpace::seated;
    immersive.fixed_in_room = headset.session().base_space() == xr::BaseSpace::stage;
    immersive.has_passthrough = headset.session().has_passthrough();
    immersive.hands = frame.hands;
    immersive.tracks_hands = true;
    immersive.vibrate = [&](xr::Side side, const xr::Vibration& vibration) {
        headset.vibrate(side, vibration);
    };
    return immersive;
}

}  // namespace bolt::view
