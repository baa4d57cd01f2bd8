#include "game/trainer/pointing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

namespace {

constexpr double easy = 1.6;          // of a nut's size in the picture: so far beside it still counts
constexpr double least_reach = 14.0;  // px, of a nut that is far away

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
        // Its size in the picture: that of a length across the line of sight.
        const Vec3 sight = centres[i] - Vec3(screen.eye.position);
        const Vec3 helper = std::abs(sight.y) < 0.9 * glm::length(sight) ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        const Vec3 across = glm::normalize(glm::cross(sight, helper));
        const auto beside = project(screen, centres[i] + 0.5 * setup.nuts[i].across_flats * across);
        if (!beside) continue;
        const double reach = std::max(easy * glm::distance(*beside, *at), least_reach);
        const double off = glm::distance(pointer, *at) / reach;
        if (off >= nearest) continue;
        nearest = off;
        found = i;
    }
    return found;
}

std::optional<double> pixels_to(const Screen& screen, const glm::dvec2& pointer, const Vec3& from,
                                const Vec3& to) {
    const auto a = project(screen, from), b = project(screen, to);
    if (!a || !b) return std::nullopt;
    const glm::dvec2 way = *b - *a;
    const double length = glm::dot(way, way);
    const double along = length > 0.0 ? std::clamp(glm::dot(pointer - *a, way) / length, 0.0, 1.0) : 0.0;
    return glm::distance(pointer, *a + along * way);
}

glm::dvec2 lever_on_screen(const Screen& screen, const Pose& tool, const Vec3& axis, double handle_length) {
    constexpr double step = 1e-3;  // rad
    const Vec3 arm = handle_length * (tool.orientation * Vec3(1, 0, 0));
    // Tightening turns about -axis.
    const Quat turn = glm::angleAxis(-step, axis);
    const auto now = project(screen, tool.position + arm), then = project(screen, tool.position + turn * arm);
    if (!now || !then) return {least_lever, 0.0};
    const glm::dvec2 lever = (*then - *now) / step;
    const double length = glm::length(lever);
    if (length < 1e-6) return {least_lever, 0.0};
    return lever * (std::max(length, least_lever) / length);
}

double turn_of_drag(const glm::dvec2& lever, const glm::dvec2& drag) {
    return glm::dot(drag, lever) / glm::dot(lever, lever);
}

namespace {

constexpr double spin_reach = 120.0;   // px of drag for the fastest twist
constexpr double wrench_reach = 22.0;  // px beside a wrench that still count

std::vector<Vec3> nut_centres(const scene::World& world, const servo::Setup& setup) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) centres.push_back(world::nut_centre(world, setup, i));
    return centres;
}

bool loosening(const session::Course& course) { return course.lesson().task == lesson::Task::loosen; }

// What the press meant: the hand, or the view.
void press(ActiveLesson& p, Wish& wish) {
    p.pointing.drags_hand = p.pointing.nut.has_value() || p.pointing.wrench;
    if (p.pointing.nut) {
        wish.nut = p.pointing.nut;
        wish.loosens = loosening(*p.course);
    } else if (p.pointing.wrench) {
        wish.wrench = true;
    }
}

double drag_of(const ActiveLesson& p, const Screen& screen, const glm::dvec2& drag) {
    if (!hand_of(p).nut || hand_of(p).doing != Doing::holding || !hand_of(p).wrench) return 0.0;
    const servo::Setup& setup = p.course->setup();
    const glm::dvec2 lever = lever_on_screen(screen, tool_of(p).pose, setup.nuts[*hand_of(p).nut].axis,
                                             setup.wrench.handle_length);
    return turn_of_drag(lever, drag);
}

void move_camera(ActiveLesson& p, const Wanted& wanted, double height, double aspect) {
    const glm::dvec2 turned =
        wanted.turned + (wanted.left && !p.pointing.drags_hand ? wanted.dragged : glm::dvec2(0.0));
    view::turn(p.view.camera.goal, glm::dvec2(turned.x, -turned.y) / height);
    view::pan(p.view.camera.goal, glm::dvec2(wanted.moved.x, -wanted.moved.y) / height);
    const glm::dvec2 at(wanted.pointer.x / height - 0.5 * aspect, 0.5 - wanted.pointer.y / height);
    if (wanted.wheel != 0.0) view::zoom(p.view.camera.goal, wanted.wheel, at, p.place.machine);
}

}  // namespace

void read_pointer(const scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    const Wanted& wanted = frame.wanted;
    const Screen screen = screen_of(p, frame.size);
    // In a slow frame the pointer comes to a nut, is pressed and is already on its way again.
    const glm::dvec2 pointer = wanted.pressed.value_or(wanted.pointer);
    if (wanted.pressed || !p.pointing.drags_hand || !wanted.left) {
        p.pointing.nut = nut_at(screen, pointer, p.course->setup(), nut_centres(world, p.course->setup()));
        const Vec3 end = hand_of(p).rest * Vec3(p.course->setup().wrench.handle_length, 0.0, 0.0);
        const auto off = pixels_to(screen, pointer, hand_of(p).rest.position, end);
        p.pointing.wrench = !hand_of(p).wrench && !p.pointing.nut && off && *off < wrench_reach;
    }
    if (wanted.wants(Action::restart_step)) go_back(p.undo, p.course->lesson(), 0);
    if (wanted.wants(Action::undo)) go_back(p.undo, p.course->lesson(), 1);
    if (p.station) {
        p.pointing.nut.reset();
        p.pointing.wrench = p.station->near_wrench;
        p.pointing.drags_hand = false;
        move_camera(p, wanted, frame.size.y, frame.size.x / frame.size.y);
        return;
    }
    Wish wish;
    wish.held = wanted.left && p.pointing.drags_hand;
    if (wanted.pressed) {
        p.pointing.press = *wanted.pressed;
        press(p, wish);
        wish.held = wanted.left && p.pointing.drags_hand;
    }
    if (wanted.wants(Action::tool)) (hand_of(p).wrench ? wish.lay_down : wish.wrench) = true;
    if (wish.held) {
        wish.turn = drag_of(p, screen, wanted.dragged);
        wish.spin = (wanted.pointer.x - p.pointing.press.x) / spin_reach;
    }
    if (p.undo.to && hand_of(p).nut) wish.retreat = true;
    if (p.pace.finished || p.pace.paused) wish = {};
    trainer::wish(p.mouse, wish, p.course->setup(), p.course->state());
    move_camera(p, wanted, frame.size.y, frame.size.x / frame.size.y);
}

}  // namespace bolt::trainer
