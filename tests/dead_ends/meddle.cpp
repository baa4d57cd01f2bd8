// Trainees who do random things.
#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "game/trainees/behaviour.hpp"
#include "tests/dead_ends/desk.hpp"

namespace dead_ends {

namespace {

std::size_t any(Random& random, std::size_t count) { return random.bits() % count; }

double any_size(Random& random, double least, double most) {
    return least * std::pow(most / least, random.uniform());
}

// A random action at the mouse: a press on something, until a time.
struct Whim {
    trainer::Wish wish;
    double until = 0.0;  // s
    double turn = 0.0;   // rad/s of dragging
    bool press = false;
    std::optional<std::size_t> undo;
    bool asks = false;
};

void press_nut(Whim& whim, Random& random, const session::Course& course, bool rough) {
    const lesson::Lesson& lesson = course.lesson();
    const bool right = random.chance(0.4) && lesson.due() != nullptr;
    whim.wish.nut = right ? lesson.due()->joint : any(random, course.setup().nuts.size());
    if (rough) whim.wish.nut = lesson.steps.back().joint;
    whim.wish.loosens = lesson.task == lesson::Task::loosen;
    whim.wish.held = true;
    const double sense = random.chance(rough ? 0.97 : 0.7) ? 1.0 : -1.0;
    whim.turn = (whim.wish.loosens ? -sense : sense) * any_size(random, rough ? 2.0 : 0.1, 40.0);
    whim.wish.spin = random.uniform(-1.5, 2.5);
    if (rough && whim.wish.loosens && random.chance(0.5)) whim.turn = std::abs(whim.turn);
    whim.until += any_size(random, 0.05, rough ? 6.0 : 4.0);
}

Whim whim_of(Random& random, const session::Course& course, bool rough) {
    Whim whim;
    whim.until = course.time();
    whim.press = true;
    const double what = random.uniform();
    if (what < 0.62) {
        press_nut(whim, random, course, rough);
    } else if (what < 0.74) {
        whim.wish.wrench = true;
        whim.until += random.uniform(0.0, 2.5);
    } else if (what < (rough ? 0.76 : 0.80)) {
        whim.wish.lay_down = true;
        whim.until += random.uniform(0.0, 2.5);
    } else if (what < 0.84) {
        whim.wish.retreat = true;
    } else if (what < (rough ? 0.86 : 0.92)) {
        whim.undo = any(random, random.chance(0.8) ? 2 : 12);
        whim.until += random.uniform(0.0, 2.0);
    } else {
        whim.asks = true;
        whim.until += any_size(random, 0.02, 1.5);
    }
    return whim;
}

// A random action at a device.
struct Grab {
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

Grab grab_of(Random& random, const session::Course& course, bool rough) {
    const servo::Setup& setup = course.setup();
    Grab grab;
    grab.until = course.time() + any_size(random, 0.01, rough ? 5.0 : 3.0);
    grab.grip = static_cast<servo::Grip>(any(random, 3));
    grab.about = anywhere(random, setup);
    grab.noise = random.chance(0.5) ? any_size(random, 1e-5, 5e-3) : 0.0;
    grab.enabled = !random.chance(0.05);
    grab.stop = random.chance(0.02);
    grab.reset = random.chance(0.1);
    grab.fresh = !random.chance(0.03);
    grab.nonsense = random.chance(0.02);
    if (random.chance(0.3)) return grab;
    grab.nut = any(random, setup.nuts.size());
    if (rough) grab.nut = course.lesson().steps.back().joint;
    if (rough) grab.grip = servo::Grip::wrench;
    grab.flipped = random.chance(0.3);
    grab.handle = random.uniform(-pi, pi);
    grab.rate = (random.chance(0.7) ? 1.0 : -1.0) * any_size(random, 0.05, 20.0);
    return grab;
}

// The next pose of the hand on its way to the target, at the speed of a hand unless it `leaps`.
Pose onward(const Grab& grab, Random& random, const session::Course& course, const Pose& hand, bool leaps) {
    Pose to = grab.about;
    if (grab.nut) {
        const servo::NutGeometry& nut = course.setup().nuts[*grab.nut];
        to = {servo::nut_centre(nut, course.state().joints[*grab.nut].nut.angle),
              motion::orientation_of(nut, grab.handle, grab.flipped)};
    }
    to.position += grab.noise * Vec3(random.normal(), random.normal(), random.normal());
    if (leaps) return to;
    const double far = glm::distance(hand.position, to.position);
    const double share = far > 1e-3 ? std::min(1.0, 1e-3 / far) : 1.0;
    return {glm::mix(hand.position, to.position, share),
            glm::slerp(hand.orientation, to.orientation, std::min(1.0, 0.02 + share))};
}

}  // namespace

void meddle_at_mouse(Desk& desk, std::uint64_t seed, double span, bool rough) {
    Random random(seed, 9101);
    Whim whim;
    while (desk.course.time() < span && !desk.over() && !desk.stuck()) {
        if (desk.course.time() >= whim.until) whim = whim_of(random, desk.course, rough);
        trainer::Wish wish = whim.wish;
        if (!std::exchange(whim.press, false)) {
            wish.nut.reset();
            wish.wrench = wish.lay_down = wish.retreat = false;
        }
        wish.turn = whim.turn * frame_seconds;
        desk.frame(wish, std::exchange(whim.undo, std::nullopt), std::exchange(whim.asks, false));
    }
}

void meddle_at_device(Desk& desk, std::uint64_t seed, double span, bool rough) {
    Random random(seed, 9102);
    const session::Course& course = desk.course;
    Grab grab;
    Pose hand = desk.player.hand.pose;
    while (course.time() < span && !desk.over() && !desk.stuck()) {
        const bool other = course.time() >= grab.until;
        if (other) grab = grab_of(random, course, rough);
        if (course.state().engagement.joint >= 0) grab.handle += grab.rate * course.setup().dt;
        hand = onward(grab, random, course, hand, other && random.chance(0.05));
        servo::Input input;
        input.device = servo::sample_of(hand);
        if (grab.nonsense) input.device.position[any(random, 3)] = std::numeric_limits<float>::quiet_NaN();
        if (grab.nonsense && random.chance(0.1)) input.device.orientation[0] = 1e30F;
        input.grip = grab.grip;
        input.enabled = grab.enabled;
        input.stop = grab.stop;
        input.reset = grab.reset;
        input.fresh = grab.fresh;
        input.missed = static_cast<std::uint8_t>(random.chance(0.01) ? any(random, 16) : 0);
        input.guide = static_cast<std::int16_t>(any(random, course.setup().nuts.size() + 1)) - 1;
        if (random.chance(5e-4)) desk.course.go_back(any(random, 10));
        desk.tick(input, grab.grip == servo::Grip::wrench, std::numeric_limits<double>::infinity(),
                  random.chance(1e-3));
    }
    desk.player.hand.pose = hand;
}

}  // namespace dead_ends
