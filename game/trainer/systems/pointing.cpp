#include "game/trainer/systems.hpp"

namespace bolt::trainer {

namespace {

constexpr double spin_reach = 120.0;   // px of drag for the fastest twist
constexpr double wrench_reach = 22.0;  // px beside a wrench that still count

std::vector<Vec3> centres_of(const play::Course& course) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < course.setup().nuts.size(); ++i)
        centres.push_back(servo::nut_centre(course.setup().nuts[i], course.state().joints[i].nut.angle));
    return centres;
}

bool loosening(const play::Course& course) { return course.lesson().task == lesson::Task::loosen; }

// What the press meant: the hand, or the view.
void press(Playing& p, Wish& wish) {
    p.hand_drag = p.under.has_value() || p.over_wrench;
    if (p.under) {
        wish.nut = p.under;
        wish.loosens = loosening(*p.course);
    } else if (p.over_wrench) {
        wish.wrench = true;
    }
}

double drag_of(const Playing& p, const Screen& screen, const glm::dvec2& drag) {
    if (!p.hand.nut || p.hand.doing != Doing::holding || !p.hand.wrench) return 0.0;
    const servo::Setup& setup = p.course->setup();
    const glm::dvec2 lever =
        lever_on_screen(screen, p.output.tool, setup.nuts[*p.hand.nut].axis, setup.wrench.handle_length);
    return turn_of_drag(lever, drag);
}

void move_camera(Playing& p, const Wanted& wanted, double height, double aspect) {
    const glm::dvec2 turned =
        wanted.turned + (wanted.left && !p.hand_drag ? wanted.dragged : glm::dvec2(0.0));
    view::turn(p.camera.goal, glm::dvec2(turned.x, -turned.y) / height);
    view::pan(p.camera.goal, glm::dvec2(wanted.moved.x, -wanted.moved.y) / height);
    const glm::dvec2 at(wanted.pointer.x / height - 0.5 * aspect, 0.5 - wanted.pointer.y / height);
    if (wanted.wheel != 0.0) view::zoom(p.camera.goal, wanted.wheel, at, p.place.machine);
}

}  // namespace

void pointing_system(scene::World&, Frame& frame) {
    Playing& p = frame.playing;
    const Wanted& wanted = frame.wanted;
    const Screen screen = screen_of(p, frame.size);
    // In a slow frame the pointer comes to a nut, is pressed and is already on its way again.
    const glm::dvec2 pointer = wanted.pressed.value_or(wanted.pointer);
    if (wanted.pressed || !p.hand_drag || !wanted.left) {
        p.under = nut_at(screen, pointer, p.course->setup(), centres_of(*p.course));
        const Vec3 end = p.hand.rest * Vec3(p.course->setup().wrench.handle_length, 0.0, 0.0);
        const auto off = pixels_to(screen, pointer, p.hand.rest.position, end);
        p.over_wrench = !p.hand.wrench && !p.under && off && *off < wrench_reach;
    }
    if (wanted.wants(Action::restart_step)) go_back(p.back, p.course->lesson(), 0);
    if (wanted.wants(Action::undo)) go_back(p.back, p.course->lesson(), 1);
    if (p.station) {
        p.under.reset();
        p.over_wrench = p.station->near_wrench;
        p.hand_drag = false;
        move_camera(p, wanted, frame.size.y, frame.size.x / frame.size.y);
        return;
    }
    Wish wish;
    wish.held = wanted.left && p.hand_drag;
    if (wanted.pressed) {
        p.press = *wanted.pressed;
        press(p, wish);
        wish.held = wanted.left && p.hand_drag;
    }
    if (wanted.wants(Action::tool)) (p.hand.wrench ? wish.lay_down : wish.wrench) = true;
    if (wish.held) {
        wish.turn = drag_of(p, screen, wanted.dragged);
        wish.spin = (wanted.pointer.x - p.press.x) / spin_reach;
    }
    if (p.back.to && p.hand.nut) wish.retreat = true;
    if (p.finished || p.paused) wish = {};
    trainer::wish(p.mouse, wish, p.course->setup(), p.course->state());
    move_camera(p, wanted, frame.size.y, frame.size.x / frame.size.y);
}

}  // namespace bolt::trainer
