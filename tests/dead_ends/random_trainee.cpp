// Trainees with random actions.
#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "game/trainees/behaviour.hpp"
#include "tests/dead_ends/lesson_run.hpp"

namespace dead_ends {

namespace {

std::size_t any(Random& random, std::size_t count) { return random.bits() % count; }

double any_size(Random& random, double least, double most) {
    return least * std::pow(most / least, random.uniform());
}

// A random action at the mouse, until a time.
struct MouseAction {
    trainer::MouseCommand command;
    double until = 0.0;  // s
    double turn = 0.0;   // rad/s of dragging
    bool press = false;
    std::optional<std::size_t> undo;
    bool hint_key = false;
};

void press_nut(MouseAction& action, Random& random, const session::LessonSession& session, bool rough) {
    const lesson::Lesson& lesson = session.lesson();
    const bool right = random.chance(0.4) && lesson.due() != nullptr;
    action.command.nut = right ? lesson.due()->joint : any(random, session.setup().nuts.size());
    if (rough) action.command.nut = lesson.steps.back().joint;
    action.command.loosens = lesson.task == lesson::Task::loosen;
    action.command.button_down = true;
    const double sense = random.chance(rough ? 0.97 : 0.7) ? 1.0 : -1.0;
    action.turn = (action.command.loosens ? -sense : sense) * any_size(random, rough ? 2.0 : 0.1, 40.0);
    action.command.spin = random.uniform(-1.5, 2.5);
    if (rough && action.command.loosens && random.chance(0.5)) action.turn = std::abs(action.turn);
    action.until += any_size(random, 0.05, rough ? 6.0 : 4.0);
}

MouseAction random_mouse_action(Random& random, const session::LessonSession& session, bool rough) {
    MouseAction action;
    action.until = session.time();
    action.press = true;
    const double what = random.uniform();
    if (what < 0.62) {
        press_nut(action, random, session, rough);
    } else if (what < 0.74) {
        action.command.take_wrench = true;
        action.until += random.uniform(0.0, 2.5);
    } else if (what < (rough ? 0.76 : 0.80)) {
        action.command.lay_down = true;
        action.until += random.uniform(0.0, 2.5);
    } else if (what < 0.84) {
        action.command.retreat = true;
    } else if (what < (rough ? 0.86 : 0.92)) {
        action.undo = any(random, random.chance(0.8) ? 2 : 12);
        action.until += random.uniform(0.0, 2.0);
    } else {
        action.hint_key = true;
        action.until += any_size(random, 0.02, 1.5);
    }
    return action;
}

// A random action at a device.
struct DeviceAction {
    servo::Grip grip = servo::Grip::none;
    Pose about;  // the target of the hand
    std::optional<std::size_t> nut;
    double handle = 0.0, rate = 0.0;  // rad, rad/s
    bool flipped = false;
    double noise = 0.0;  // m
    double until = 0.0;  // s
    bool enabled = true, stop = false, reset = false, fresh = true, nonsense = false;
};

Pose anywhere(Random& random, const servo::Setup& setup) {
    const servo::NutGeometry& nut = setup.nuts[any(random, setup.nuts.size())];
    const Vec3 off(random.normal(), random.normal(), random.normal());
    const Vec3 spun(random.normal(), random.normal(), random.normal());
    return {nut.seat + off * any_size(random, 0.003, 0.3), rotation(spun * random.uniform(0.0, 2.0))};
}

DeviceAction random_device_action(Random& random, const session::LessonSession& session, bool rough) {
    const servo::Setup& setup = session.setup();
    DeviceAction action;
    action.until = session.time() + any_size(random, 0.01, rough ? 5.0 : 3.0);
    action.grip = static_cast<servo::Grip>(any(random, 3));
    action.about = anywhere(random, setup);
    action.noise = random.chance(0.5) ? any_size(random, 1e-5, 5e-3) : 0.0;
    action.enabled = !random.chance(0.05);
    action.stop = random.chance(0.02);
    action.reset = random.chance(0.1);
    action.fresh = !random.chance(0.03);
    action.nonsense = random.chance(0.02);
    if (random.chance(0.3)) return action;
    action.nut = any(random, setup.nuts.size());
    if (rough) action.nut = session.lesson().steps.back().joint;
    if (rough) action.grip = servo::Grip::wrench;
    action.flipped = random.chance(0.3);
    action.handle = random.uniform(-pi, pi);
    action.rate = (random.chance(0.7) ? 1.0 : -1.0) * any_size(random, 0.05, 20.0);
    return action;
}

// The next pose of the hand on its way to the target, at the speed of a hand unless it `leaps`.
Pose onward(const DeviceAction& action, Random& random, const session::LessonSession& session,
            const Pose& hand, bool leaps) {
    Pose to = action.about;
    if (action.nut) {
        const servo::NutGeometry& nut = session.setup().nuts[*action.nut];
        to = {servo::nut_centre(nut, session.state().joints[*action.nut].nut.angle),
              motion::tool_orientation(nut, action.handle, action.flipped)};
    }
    to.position += action.noise * Vec3(random.normal(), random.normal(), random.normal());
    if (leaps) return to;
    const double far = glm::distance(hand.position, to.position);
    const double share = far > 1e-3 ? std::min(1.0, 1e-3 / far) : 1.0;
    return {glm::mix(hand.position, to.position, share),
            glm::slerp(hand.orientation, to.orientation, std::min(1.0, 0.02 + share))};
}

}  // namespace

void act_randomly_at_mouse(LessonRun& run, std::uint64_t seed, double span, bool rough) {
    Random random(seed, 9101);
    MouseAction action;
    while (run.session.time() < span && !run.over() && !run.failed()) {
        if (run.session.time() >= action.until) action = random_mouse_action(random, run.session, rough);
        trainer::MouseCommand command = action.command;
        if (!std::exchange(action.press, false)) {
            command.nut.reset();
            command.take_wrench = command.lay_down = command.retreat = false;
        }
        command.turn = action.turn * frame_seconds;
        run.frame(command, std::exchange(action.undo, std::nullopt), std::exchange(action.hint_key, false));
    }
}

void act_randomly_at_device(LessonRun& run, std::uint64_t seed, double span, bool rough) {
    Random random(seed, 9102);
    const session::LessonSession& session = run.session;
    DeviceAction action;
    Pose hand = run.player.hand.pose;
    while (session.time() < span && !run.over() && !run.failed()) {
        const bool other = session.time() >= action.until;
        if (other) action = random_device_action(random, session, rough);
        if (session.state().engagement.joint >= 0) action.handle += action.rate * session.setup().dt;
        hand = onward(action, random, session, hand, other && random.chance(0.05));
        servo::TickInput input;
        input.commanded_tool = servo::to_commanded_tool(hand);
        if (action.nonsense)
            input.commanded_tool.position[any(random, 3)] = std::numeric_limits<float>::quiet_NaN();
        if (action.nonsense && random.chance(0.1)) input.commanded_tool.orientation[0] = 1e30F;
        input.grip = action.grip;
        input.dead_man = action.enabled;
        input.stop = action.stop;
        input.reset = action.reset;
        input.fresh = action.fresh;
        input.missed = static_cast<std::uint8_t>(random.chance(0.01) ? any(random, 16) : 0);
        input.guided_joint = static_cast<std::int16_t>(any(random, session.setup().nuts.size() + 1)) - 1;
        if (random.chance(5e-4)) run.session.request_undo(any(random, 10));
        run.tick(input, action.grip == servo::Grip::wrench, std::numeric_limits<double>::infinity(),
                 random.chance(1e-3));
    }
    run.player.hand.pose = hand;
}

}  // namespace dead_ends
