#include "game/trainer/dragged_hand.hpp"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <utility>

namespace bolt::trainer {

namespace {

constexpr double notch_step = 0.02;              // m along the view for a notch
constexpr double notch_step_on_bolt = 0.01;      // m along the bolt
constexpr double notch_turn = to_radians(30.0);  // of the fingers for a notch; less than 0.6 rad,
                                                 // device::HandMotion::max_angular_deflection
// s in which the hand follows a notch of the mouse wheel. An immediate step would move the tool into the
// workpiece at 1 m/s and make the fingers slip off the nut.
constexpr double notch_time = 0.1, min_notch = 1e-3;
constexpr double finger_turn = to_radians(2.5);  // of the fingers for a pixel of drag
constexpr double key_speed = 0.25;               // m/s
constexpr double key_turn_speed = 1.5;           // rad/s
// 1/s, rate at which closing fingers move onto the nut beside them. The lesson trains placing a tool, not
// pinching.
constexpr double finger_rate = 6.0;

// 1/s, HandMotion::compliance_rate in the air: the largest guiding force, 2.4 N, deflects the hand's spring
// of 300 N/m by 8 mm and so moves the hand at 2.4 cm/s. On a bolt it is 0, because the hand holds what it has
// pulled.
constexpr double air_compliance = 3.0;

// m, HandMotion::max_deflection in the air. The hand's spring of 300 N/m then pulls with less than the 12 N
// of the arm, so that the hand cannot push through a wall that holds the wrench.
constexpr double air_deflection = 0.035;

constexpr double min_depth = 0.15;  // m before the eye

// Sine of an angle between the view and the plane across the bolt. At a smaller angle a drag moves the wrench
// in the plane of the picture.
constexpr double min_slope = 0.25;

// Before the hand releases a wrench on a nut, it yields for a short time. Otherwise the wrench would keep its
// tension until the hand takes it again.
constexpr double ease_time = 0.3;         // s
constexpr double ease_compliance = 30.0;  // 1/s

// A motion of the hand in the assembly's frame. The turn is about the tool's origin.
struct HandShift {
    Vec3 shift{0.0};  // m
    Vec3 turn{0.0};   // rad
};

// The movement in the plane of the picture, at the depth of `point`, that looks like `drag` (px). The depth
// is at least min_depth, so that a hand beside or behind the eye can be dragged back.
Vec3 in_picture(const Projection& projection, const Vec3& point, const glm::dvec2& drag) {
    const glm::dmat4 to_clip(projection.eye.clip_from_world);
    glm::dvec4 clip = to_clip * glm::dvec4(point, 1.0);
    const glm::dvec3 ahead(to_clip[0][3], to_clip[1][3], to_clip[2][3]);  // gradient of the depth
    if (clip.w < min_depth)
        clip =
            to_clip * glm::dvec4(point + Vec3(ahead) * ((min_depth - clip.w) / glm::dot(ahead, ahead)), 1.0);
    const glm::dvec4 moved =
        clip +
        glm::dvec4(2.0 * drag.x / projection.size.x, 2.0 * drag.y / projection.size.y, 0.0, 0.0) * clip.w;
    const glm::dmat4 to_world = glm::inverse(to_clip);
    const glm::dvec4 from = to_world * clip, at = to_world * moved;
    return Vec3(at) / at.w - Vec3(from) / from.w;
}

Vec3 view_direction(const DragScene& scene) {
    return glm::normalize(scene.tool.position - Vec3(scene.projection.eye.position));
}

bool turns_tool(const DragInput& input) { return input.turns || input.mouse.turn_drag != glm::dvec2(0.0); }

// The point that the hand holds: the end of the handle, or without a wrench the tool's origin.
Vec3 handle_end(const DragScene& scene) {
    return scene.tool * Vec3(scene.wrench ? scene.handle_length : 0.0, 0.0, 0.0);
}

// The part of the pending notches that the hand follows in this frame. Notches count only while the button is
// held.
double followed_notches(DraggedHand& hand, const DragInput& input) {
    hand.scroll = input.mouse.left_down ? hand.scroll + input.mouse.scroll : 0.0;
    const double followed = std::min(1.0, input.seconds / notch_time) * hand.scroll;
    hand.scroll = std::abs(hand.scroll - followed) < min_notch ? 0.0 : hand.scroll - followed;
    return followed;
}

// Away from the viewer along the bolt for a positive number of notches.
Vec3 along_bolt(const DragScene& scene, const Vec3& axis, double notches) {
    const double away = glm::dot(axis, view_direction(scene)) < 0.0 ? -1.0 : 1.0;
    return notches * notch_step_on_bolt * away * axis;
}

HandShift swing_on_bolt(const DragInput& input, const DragScene& scene) {
    const Vec3& axis = scene.nut->axis;
    const glm::dvec2 lever = lever_on_screen(scene.projection, scene.tool, axis, scene.handle_length);
    const double angle = -drag_angle(lever, input.mouse.left_drag);
    const Vec3 handle = handle_end(scene) - scene.tool.position;
    return {angle * glm::cross(axis, handle) + along_bolt(scene, axis, input.mouse.scroll), Vec3(0.0)};
}

HandShift twist_nut(const DragInput& input, const DragScene& scene) {
    const double angle = finger_turn * input.mouse.left_drag.x + notch_turn * input.mouse.scroll;
    return {Vec3(0.0), -angle * scene.nut->axis};
}

HandShift fingers_to_nut(const DragInput& input, const DragScene& scene) {
    const double share = std::min(1.0, finger_rate * input.seconds);
    const Vec3 normal = scene.tool.orientation * Vec3(0.0, 0.0, 1.0);
    const Vec3 axis = glm::dot(normal, scene.nut->axis) < 0.0 ? -scene.nut->axis : scene.nut->axis;
    return {share * (scene.nut->centre - scene.tool.position), share * glm::cross(normal, axis)};
}

// Returns the shift across the bolt that looks like `shift` in the picture. If the view is nearly parallel to
// the plane across the bolt, this shift would be too long; then returns `shift` itself.
Vec3 across_bolt(const DragScene& scene, const Vec3& axis, const Vec3& shift) {
    const Vec3 view = glm::normalize(handle_end(scene) - Vec3(scene.projection.eye.position));
    const double slope = glm::dot(view, axis);
    return std::abs(slope) < min_slope ? shift : shift - glm::dot(shift, axis) / slope * view;
}

// Beside a bolt a drag moves the wrench across the bolt and the mouse wheel along it, because depth along the
// view is too hard to judge for placing the jaw.
HandShift beside_bolt(const DragInput& input, const DragScene& scene) {
    const Vec3& axis = scene.nut->axis;
    const Vec3 shift = in_picture(scene.projection, handle_end(scene), input.mouse.left_drag);
    return {across_bolt(scene, axis, shift) + along_bolt(scene, axis, input.mouse.scroll), Vec3(0.0)};
}

HandShift in_the_air(const DragInput& input, const DragScene& scene) {
    HandShift motion;
    if (turns_tool(input)) {
        const Vec3 normal = scene.tool.orientation * Vec3(0.0, 0.0, 1.0);
        const glm::dvec2 lever = lever_on_screen(scene.projection, scene.tool, normal, scene.handle_length);
        motion.turn = -drag_angle(lever, input.mouse.left_drag) * normal;
    } else {
        motion.shift = in_picture(scene.projection, handle_end(scene), input.mouse.left_drag);
    }
    motion.shift += notch_step * input.mouse.scroll * view_direction(scene);
    return motion;
}

HandShift mouse_motion(const DraggedHand& hand, const DragInput& input, const DragScene& scene) {
    if (!input.mouse.left_down) return {};
    if (scene.nut && scene.engaged)
        return scene.wrench ? swing_on_bolt(input, scene) : twist_nut(input, scene);
    if (scene.nut && !scene.wrench && hand.grasps) return fingers_to_nut(input, scene);
    if (scene.nut && scene.wrench && !turns_tool(input)) return beside_bolt(input, scene);
    return in_the_air(input, scene);
}

}  // namespace

void drag_hand(DraggedHand& hand, const DragInput& input, const DragScene& scene) {
    if (input.mouse.pressed_at) hand.grasps = scene.points_at_reachable;
    if (!input.mouse.left_down) hand.grasps = false;
    const bool let_go = std::exchange(hand.button_down, input.mouse.left_down) && !hand.button_down;
    hand.easing =
        let_go && scene.wrench && scene.engaged ? ease_time : std::max(0.0, hand.easing - input.seconds);
    if (hand.button_down) hand.easing = 0.0;
    const bool eases = hand.easing > 0.0;
    const bool closed =
        (hand.button_down && (hand.grasps || scene.wrench)) || input.keys.buttons != 0 || eases;
    hand.motion.buttons = closed ? 1 : 0;

    hand.motion.compliance_rate = eases ? ease_compliance : scene.engaged ? 0.0 : air_compliance;
    DragInput smooth = input;
    smooth.mouse.scroll = followed_notches(hand, input);
    // The intended pose may be far ahead of the arm only while the hand pulls the handle: only this needs the
    // arm's full force, so that the user can overtighten.
    const bool pulls = scene.engaged && smooth.mouse.scroll == 0.0;
    hand.motion.max_deflection = pulls ? device::HandMotion{}.max_deflection : air_deflection;
    HandShift motion = mouse_motion(hand, smooth, scene);
    motion.shift += key_speed * input.seconds * (scene.arm_to_assembly * input.keys.along);
    motion.turn += key_turn_speed * input.seconds * (scene.arm_to_assembly * input.keys.about);
    // The arm is at the end of the handle, and a turn about the jaw moves that end.
    const Vec3 handle = handle_end(scene) - scene.tool.position;
    motion.shift += rotation(motion.turn) * handle - handle;

    const Quat back = glm::conjugate(scene.arm_to_assembly);
    hand.motion.moved += back * motion.shift / scene.scale;
    hand.motion.turned = glm::normalize(rotation(back * motion.turn) * hand.motion.turned);
}

}  // namespace bolt::trainer
