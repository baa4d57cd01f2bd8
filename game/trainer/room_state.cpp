#include "game/trainer/room_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "game/scene/workplace.hpp"

namespace bolt::trainer {

namespace {

// m, horizontally, to the front of the workpiece, for a user with the usual reach.
constexpr double head_to_workpiece = 0.40;
constexpr double panel_below_eyes = 0.02, panel_least_height = 0.9;  // m
// Deflections of a stick: above the first it turns or raises the workpiece, below the second it is at rest.
constexpr float stick_turns = 0.7F, stick_rests = 0.3F;
constexpr double stick_raise = 0.2, max_raise = 0.4;          // m/s; m
constexpr double menu_hold = 1.0;                             // s
constexpr float pressed_above = 0.6F, released_below = 0.4F;  // of the trigger
// Design choices. The angles are from the direction of the head, rad: the vignette is clear inside its edge
// and black from `vignette_blur` outside it. When it is fully open, its edge is outside the view.
constexpr double vignette_closed = to_radians(25.0), vignette_open = to_radians(70.0),
                 vignette_blur = to_radians(15.0);
constexpr double vignette_closing = 0.1, vignette_opening = 0.4;         // s
constexpr double visible_speed = 0.005;                                  // m/s and rad/s
constexpr double max_motion = 0.05, max_motion_angle = to_radians(5.0);  // m and rad in a frame

// The rotation about the vertical that turns −z to where the head looks.
Quat heading(const Pose& head) {
    const Vec3 right = head.orientation * Vec3(1.0, 0.0, 0.0);
    return glm::angleAxis(std::atan2(-right.z, right.x), Vec3(0.0, 1.0, 0.0));
}

Vec3 middle_of(const render::BoundingBox& box) { return 0.5 * (Vec3(box.low) + Vec3(box.high)); }

void add_key(std::vector<platform::InputEvent>& events, platform::Key key, bool down, bool& was_down) {
    if (std::exchange(was_down, down) != down) events.emplace_back(platform::KeyEvent{key, down, false, {}});
}

// When the menu button has been held for long enough, requests once to place all again.
void hold_menu(RoomState& room, bool down, double& held, double seconds) {
    const double before = std::exchange(held, down ? held + seconds : 0.0);
    if (before < menu_hold && held >= menu_hold) room.placement.requested = true;
}

// The stick turns the workpiece by steps, once for each deflection: smooth turning makes people sick.
void apply_stick(RoomState& room, const glm::vec2& stick, bool& used, double seconds) {
    if (!used && std::abs(stick.x) > stick_turns) {
        room.turns += stick.x > 0.0F ? 1 : -1;
        used = true;
    }
    if (std::abs(stick.x) < stick_rests) used = false;
    if (std::abs(stick.y) > stick_turns)
        raise(room, std::copysign(stick_raise * seconds, static_cast<double>(stick.y)));
}

// A ring around the direction of the head, in the picture of an eye: vertices at three angles from it, clear
// at the first, black at the others.
render::Overlay vignette_ring(const render::Eye& eye, const Quat& head, VkExtent2D size, double edge) {
    constexpr std::uint32_t segments = 48;
    const std::array<double, 3> angles{edge, edge + vignette_blur, to_radians(88.0)};
    render::Overlay overlay;
    const glm::vec2 half = 0.5F * glm::vec2(size.width, size.height);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double around = 2.0 * pi * i / segments;
        for (std::size_t ring = 0; ring < angles.size(); ++ring) {
            const double out = std::sin(angles[ring]);
            const glm::vec3 direction(
                head * Vec3(out * std::cos(around), out * std::sin(around), -std::cos(angles[ring])));
            const glm::vec4 clip = eye.clip_from_world * glm::vec4(eye.position + direction, 1.0F);
            overlay.vertices.push_back(
                {half + half * glm::vec2(clip) / std::max(clip.w, 0.01F), {}, ring == 0 ? 0U : 0xFF000000U});
            const auto first = static_cast<std::uint32_t>(ring + 3 * i);
            const auto next = static_cast<std::uint32_t>(ring + 3 * ((i + 1) % segments));
            if (ring + 1 < angles.size())
                overlay.indices.insert(overlay.indices.end(),
                                       {first, first + 1, next, next, first + 1, next + 1});
        }
    }
    render::OverlayDraw draw;
    draw.scissor = {{0, 0}, size};
    draw.count = static_cast<std::uint32_t>(overlay.indices.size());
    overlay.draws.push_back(draw);
    return overlay;
}

}  // namespace

Pose place_workpiece(const Pose& head, const render::BoundingBox& box, const UserBody& user) {
    const Quat turn = heading(head);
    const Vec3 front(
        0.5 * static_cast<double>(box.low.x + box.high.x), 0.0,
        static_cast<double>(box.high.z) + head_to_workpiece * user.arm_reach / content::usual_arm_reach);
    Pose place{head.position - turn * front, turn};
    const double floor = static_cast<double>(box.low.y) - scene::floor_below_plate;
    place.position.y = (user.seated_eyes ? head.position.y - *user.seated_eyes : 0.0) - floor;
    return place;
}

Pose moved_into_view(const Pose& workpiece, const render::BoundingBox& box, const Pose& head,
                     const std::function<bool(const Vec3&)>& shows) {
    constexpr double farthest = 2.5, step = 0.05,
                     margin = 0.1;  // m; the margin around the box is for the hand
    const Vec3 low = Vec3(box.low) - margin, high = Vec3(box.high) + margin;
    const Vec3 away = heading(head) * Vec3(0.0, 0.0, -1.0);
    const auto seen_corners = [&](const Pose& place) {
        int seen = 0;
        for (unsigned corner = 0; corner < 8; ++corner)
            seen +=
                shows(place * Vec3((corner & 1U) != 0 ? high.x : low.x, (corner & 2U) != 0 ? high.y : low.y,
                                   (corner & 4U) != 0 ? high.z : low.z))
                    ? 1
                    : 0;
        return seen;
    };
    Pose best = workpiece;
    int most = seen_corners(best);
    for (double distance = step; distance <= farthest && most < 8; distance += step) {
        const Pose place{workpiece.position + distance * away, workpiece.orientation};
        if (const int seen = seen_corners(place); seen > most) {
            most = seen;
            best = place;
        }
    }
    return best;
}

Pose place_panel(const Pose& head) {
    const Quat turn = heading(head);
    Vec3 centre = head.position + turn * Vec3(0.0, -panel_below_eyes, -panel_distance);
    centre.y = std::max(centre.y, panel_least_height);
    return {centre, turn};
}

Pose adjusted(const Pose& workpiece, const render::BoundingBox& box, int turns, double height) {
    const Vec3 middle = middle_of(box);
    const Pose turned{{0.0, height, 0.0}, glm::angleAxis(turns * turn_step, Vec3(0.0, 1.0, 0.0))};
    return workpiece * Pose{middle, {1.0, 0.0, 0.0, 0.0}} * turned * Pose{-middle, {1.0, 0.0, 0.0, 0.0}};
}

void raise(RoomState& room, double height) {
    room.height = std::clamp(room.height + height, -max_raise, max_raise);
}

std::optional<glm::dvec2> panel_hit(const view::PanelPlace& panel, const Pose& aim) {
    const Pose in_panel = inverse(panel.pose) * aim;
    const Vec3 along = in_panel.orientation * Vec3(0.0, 0.0, -1.0);
    if (in_panel.position.z <= 0.0 || along.z > -1e-3) return std::nullopt;
    const Vec3 hit = in_panel.position - along * (in_panel.position.z / along.z);
    const glm::dvec2 points(0.5 * panel_points.x + hit.x / panel.point_size,
                            0.5 * panel_points.y - hit.y / panel.point_size);
    if (points.x < 0.0 || points.y < 0.0 || points.x > panel_points.x || points.y > panel_points.y)
        return std::nullopt;
    return points * static_cast<double>(panel_scale);
}

Vec3 point_on_panel(const view::PanelPlace& panel, const glm::dvec2& at) {
    const glm::dvec2 from_middle = at / static_cast<double>(panel_scale) - 0.5 * panel_points;
    return panel.pose * Vec3(from_middle.x * panel.point_size, -from_middle.y * panel.point_size, 0.0);
}

std::vector<platform::InputEvent> hand_events(RoomState& room, const xr::Hands& hands, const HandKeys& keys,
                                              double seconds, std::optional<xr::Side> working) {
    std::vector<platform::InputEvent> events;
    std::optional<glm::dvec2> at;
    float select = 0.0F;
    room.controller = nullptr;
    std::optional<xr::Side> by;
    for (std::size_t side = 0; side < hands.sides.size(); ++side) {
        const xr::HandInput& hand = hands.sides[side];
        add_key(events, keys.pause, hand.active && hand.menu, room.menu_down[side]);
        hold_menu(room, hand.active && hand.menu, room.menu_held[side], seconds);
        add_key(events, keys.tool, hand.active && hand.secondary, room.secondary_down[side]);
        apply_stick(room, hand.active ? hand.stick : glm::vec2(0.0F), room.stick_used[side], seconds);
        if (hand.active && hand.controller != nullptr) room.controller = hand.controller;
        if (!hand.active || !hand.aim || !room.panel || working == static_cast<xr::Side>(side)) continue;
        const auto hit = panel_hit({*room.panel, room.panel_point_size}, hand.aim->pose);
        // If both hands point at the panel, the one that presses harder counts; if equal, the right one.
        if (!hit || (at && hand.select < select)) continue;
        at = hit;
        by = static_cast<xr::Side>(side);
        select = hand.select;
    }
    PanelPointer& pointer = room.pointer;
    pointer.on_panel = at.has_value();
    pointer.side = by;
    if (at) {
        pointer.at = *at;
        events.emplace_back(platform::CursorEvent{*at});
    }
    const bool presses = at && select > (pointer.pressed ? released_below : pressed_above);
    if (presses != pointer.pressed)
        events.emplace_back(platform::ButtonEvent{platform::Button::left, presses, pointer.at});
    pointer.pressed = presses;
    return events;
}

glm::dvec2* pointer_position(platform::InputEvent& event) {
    if (auto* cursor = std::get_if<platform::CursorEvent>(&event)) return &cursor->at;
    if (auto* button = std::get_if<platform::ButtonEvent>(&event)) return &button->at;
    if (auto* wheel = std::get_if<platform::WheelEvent>(&event)) return &wheel->at;
    return nullptr;
}

void move_to_panel(std::span<platform::InputEvent> events, const VkRect2D& shown) {
    if (shown.extent.width == 0 || shown.extent.height == 0) return;
    const glm::dvec2 offset(shown.offset.x, shown.offset.y), size(shown.extent.width, shown.extent.height);
    const glm::dvec2 panel(panel_extent.width, panel_extent.height);
    for (platform::InputEvent& event : events)
        if (glm::dvec2* at = pointer_position(event)) *at = (*at - offset) / size * panel;
}

static std::vector<render::Eye> eyes_in_scene(const view::EyeGroup& group, const Pose& scene_in_room) {
    std::vector<render::Eye> eyes;
    for (const render::Eye& eye : group.eyes) eyes.push_back(render::seen_from(eye, scene_in_room));
    return eyes;
}

Status draw_in_room(render::Renderer& renderer, gpu::FrameContext& frame, const render::Scene& scene,
                    const Pose& scene_in_room, const view::ImmersiveFrame& immersive) {
    for (std::uint32_t i = 0; i < immersive.groups.size(); ++i) {
        const std::vector<render::Eye> eyes = eyes_in_scene(immersive.groups[i], scene_in_room);
        if (!eyes.empty())
            BOLT_TRY(
                renderer.render(frame, scene, eyes, immersive.groups[i].size, view::immersive_group + i));
    }
    return {};
}

void move_eyes_in_room(render::Renderer& renderer, const Pose& scene_in_room,
                       const view::ImmersiveFrame& immersive) {
    for (std::uint32_t i = 0; i < immersive.groups.size(); ++i)
        renderer.move_eyes(eyes_in_scene(immersive.groups[i], scene_in_room), view::immersive_group + i);
}

void update(Vignette& vignette, const Pose& scene_in_room, double seconds) {
    const std::optional<Pose> before = std::exchange(vignette.scene, scene_in_room);
    bool moves = false;
    if (before && seconds > 0.0) {
        const double motion = glm::distance(before->position, scene_in_room.position);
        const double turn = glm::length(turn_between(before->orientation, scene_in_room.orientation));
        moves = motion < max_motion && turn < max_motion_angle &&
                std::max(motion, turn) > visible_speed * seconds;
    }
    vignette.strength = moves ? std::min(1.0, vignette.strength + seconds / vignette_closing)
                              : std::max(0.0, vignette.strength - seconds / vignette_opening);
}

Status draw_vignette(render::Renderer& renderer, gpu::FrameContext& frame, const Vignette& vignette,
                     const view::ImmersiveFrame& immersive) {
    if (vignette.strength <= 0.0) return {};
    const double edge = vignette_open + vignette.strength * (vignette_closed - vignette_open);
    for (std::uint32_t i = 0; i < immersive.groups.size(); ++i) {
        const view::EyeGroup& group = immersive.groups[i];
        for (std::uint32_t eye = 0; eye < group.eyes.size(); ++eye)
            BOLT_TRY(renderer.draw_over(
                frame, vignette_ring(group.eyes[eye], immersive.head.orientation, group.size, edge),
                renderer.picture(eye, view::immersive_group + i)));
    }
    return {};
}

render::Panel panel_in_scene(const view::PanelPlace& panel, const Pose& scene_in_room,
                             const gpu::Image& picture) {
    const Pose at = inverse(scene_in_room) * panel.pose;
    const glm::dvec2 half = 0.5 * panel.point_size * panel_points;
    render::Panel shown;
    shown.picture = &picture;
    shown.centre = glm::vec3(at.position);
    shown.right = glm::vec3(at.orientation * Vec3(half.x, 0.0, 0.0));
    shown.up = glm::vec3(at.orientation * Vec3(0.0, half.y, 0.0));
    return shown;
}

}  // namespace bolt::trainer
