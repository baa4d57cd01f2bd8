#include "game/trainer/systems.hpp"

namespace bolt::trainer {

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
