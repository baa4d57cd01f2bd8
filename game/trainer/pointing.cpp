#include "game/trainer/pointing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

namespace {

constexpr double pick_margin = 1.6;  // picking radius relative to a nut's apparent size
constexpr double min_reach = 14.0;   // px, for a distant nut

}  // namespace

std::optional<glm::dvec2> project(const Screen& screen, const Vec3& point) {
    const glm::dvec4 clip = glm::dmat4(screen.eye.clip_from_world) * glm::dvec4(point, 1.0);
    if (clip.w <= 1e-9) return std::nullopt;
    return glm::dvec2(0.5 * (clip.x / clip.w + 1.0), 0.5 * (clip.y / clip.w + 1.0)) * screen.size;
}

std::optional<std::size_t> nut_at(const Screen& screen, const glm::dvec2& pointer, const servo::Setup& setup,
                                  std::span<const Vec3> centres) {
    std::optional<std::size_t> found;
    double nearest = 1.0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        const auto at = project(screen, centres[i]);
        if (!at) continue;
        // Apparent size: the projection of a length across the line of sight.
        const Vec3 sight = centres[i] - Vec3(screen.eye.position);
        const Vec3 helper = std::abs(sight.y) < 0.9 * glm::length(sight) ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        const Vec3 across = glm::normalize(glm::cross(sight, helper));
        const auto beside = project(screen, centres[i] + 0.5 * setup.nuts[i].across_flats * across);
        if (!beside) continue;
        const double reach = std::max(pick_margin * glm::distance(*beside, *at), min_reach);
        const double off = glm::distance(pointer, *at) / reach;
        if (off >= nearest) continue;
        nearest = off;
        found = i;
    }
    return found;
}

std::optional<double> pixels_to_segment(const Screen& screen, const glm::dvec2& pointer, const Vec3& from,
                                        const Vec3& to) {
    const auto a = project(screen, from), b = project(screen, to);
    if (!a || !b) return std::nullopt;
    const glm::dvec2 segment = *b - *a;
    const double length = glm::dot(segment, segment);
    const double along = length > 0.0 ? std::clamp(glm::dot(pointer - *a, segment) / length, 0.0, 1.0) : 0.0;
    return glm::distance(pointer, *a + along * segment);
}

glm::dvec2 lever_on_screen(const Screen& screen, const Pose& tool, const Vec3& axis, double handle_length) {
    constexpr double step = 1e-3;  // rad
    const Vec3 arm = handle_length * (tool.orientation * Vec3(1, 0, 0));
    // Tightening turns about -axis.
    const Quat turn = glm::angleAxis(-step, axis);
    const auto now = project(screen, tool.position + arm), then = project(screen, tool.position + turn * arm);
    if (!now || !then) return {min_lever, 0.0};
    const glm::dvec2 lever = (*then - *now) / step;
    const double length = glm::length(lever);
    if (length < 1e-6) return {min_lever, 0.0};
    return lever * (std::max(length, min_lever) / length);
}

double drag_angle(const glm::dvec2& lever, const glm::dvec2& drag) {
    return glm::dot(drag, lever) / glm::dot(lever, lever);
}

namespace {

constexpr double full_spin_drag = 120.0;  // px of drag that give the fastest twist
constexpr double wrench_reach = 22.0;     // px from the wrench within which it is picked

std::vector<Vec3> nut_centres(const scene::SceneWorld& world, const servo::Setup& setup) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) centres.push_back(world::nut_centre(world, setup, i));
    return centres;
}

bool loosening(const session::LessonSession& session) {
    return session.lesson().task == lesson::Task::loosen;
}

// Decides whether a press moves the hand or the view.
void press(ActiveLesson& active, MouseCommand& command) {
    active.pointer.drags_hand = active.pointer.nut.has_value() || active.pointer.on_wrench;
    if (active.pointer.nut) {
        command.nut = active.pointer.nut;
        command.loosens = loosening(*active.session);
    } else if (active.pointer.on_wrench) {
        command.take_wrench = true;
    }
}

double handle_turn(const ActiveLesson& active, const Screen& screen, const glm::dvec2& drag) {
    if (!hand_of(active).nut || hand_of(active).action != HandAction::holding || !hand_of(active).wrench)
        return 0.0;
    const servo::Setup& setup = active.session->setup();
    const glm::dvec2 lever = lever_on_screen(
        screen, tool_of(active).pose, setup.nuts[*hand_of(active).nut].axis, setup.wrench.handle_length);
    return drag_angle(lever, drag);
}

void move_camera(ActiveLesson& active, const FrameInput& input, double height, double aspect) {
    const glm::dvec2 turned =
        input.right_drag +
        (input.left_down && !active.pointer.drags_hand ? input.left_drag : glm::dvec2(0.0));
    view::turn(active.view.camera.goal, glm::dvec2(turned.x, -turned.y) / height);
    view::pan(active.view.camera.goal, glm::dvec2(input.middle_drag.x, -input.middle_drag.y) / height);
    const glm::dvec2 at(input.pointer.x / height - 0.5 * aspect, 0.5 - input.pointer.y / height);
    if (input.wheel != 0.0) view::zoom(active.view.camera.goal, input.wheel, at, active.workplace.machine);
}

}  // namespace

void handle_input(const scene::SceneWorld& world, Frame& frame) {
    ActiveLesson& active = frame.active;
    const FrameInput& input = frame.input;
    const Screen screen = screen_of(active, frame.size);
    // In a slow frame the pointer may have left the place of the press already.
    const glm::dvec2 pointer = input.pressed_at.value_or(input.pointer);
    if (input.pressed_at || !active.pointer.drags_hand || !input.left_down) {
        active.pointer.nut =
            nut_at(screen, pointer, active.session->setup(), nut_centres(world, active.session->setup()));
        const Vec3 end = hand_of(active).rest * Vec3(active.session->setup().wrench.handle_length, 0.0, 0.0);
        const auto off = pixels_to_segment(screen, pointer, hand_of(active).rest.position, end);
        active.pointer.on_wrench =
            !hand_of(active).wrench && !active.pointer.nut && off && *off < wrench_reach;
    }
    if (input.triggered(Action::restart_step)) request_undo(active.undo, active.session->lesson(), 0);
    if (input.triggered(Action::undo)) request_undo(active.undo, active.session->lesson(), 1);
    if (active.station) {
        active.pointer.nut.reset();
        active.pointer.on_wrench = active.station->near_wrench;
        active.pointer.drags_hand = false;
        move_camera(active, input, frame.size.y, frame.size.x / frame.size.y);
        return;
    }
    MouseCommand command;
    command.held = input.left_down && active.pointer.drags_hand;
    if (input.pressed_at) {
        active.pointer.press_position = *input.pressed_at;
        press(active, command);
        command.held = input.left_down && active.pointer.drags_hand;
    }
    if (input.triggered(Action::tool))
        (hand_of(active).wrench ? command.lay_down : command.take_wrench) = true;
    if (command.held) {
        command.turn = handle_turn(active, screen, input.left_drag);
        command.spin = (input.pointer.x - active.pointer.press_position.x) / full_spin_drag;
    }
    if (active.undo.target && hand_of(active).nut) command.retreat = true;
    if (active.clock.finished || active.clock.paused) command = {};
    trainer::apply_command(active.mouse, command, active.session->setup(), active.session->state());
    move_camera(active, input, frame.size.y, frame.size.x / frame.size.y);
}

}  // namespace bolt::trainer
