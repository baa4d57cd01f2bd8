// Simulated hands: what they do under a force, held against the closed form, and that they know of it by
// nothing else.
#include "game/trainees/human_model.hpp"

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "game/lesson/lesson.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"

using namespace bolt;
using namespace bolt::trainees;

namespace {

constexpr double dt = 1e-3;
const Pose meant{{0.1, -0.2, 0.3}, rotation(Vec3(0.3, -0.2, 0.9))};

Pose held_for(const Impedance& i, Arm& arm, const force::OutputCommand& felt, double seconds,
              bool grips = false) {
    Pose pose = meant;
    for (int k = 0; k < static_cast<int>(seconds / dt); ++k) pose = follow(i, arm, meant, felt, grips, dt);
    return pose;
}

double angle_between(const Pose& a, const Pose& b) {
    return glm::length(rotation_vector(glm::normalize(a.orientation * glm::conjugate(b.orientation))));
}

}  // namespace

TEST_CASE("Arm: a steady force moves a hand by F/k, a torque turns it by T/k, and it comes back") {
    const Impedance i;
    Arm arm;
    const Vec3 force(0.6, -1.2, 0.3), torque(0.02, 0.05, -0.01);
    const Pose pushed = held_for(i, arm, {force, torque}, 2.0);
    CHECK(glm::length(pushed.position - meant.position - force / i.stiffness) < 1e-6);
    CHECK(angle_between(pushed, meant) ==
          doctest::Approx(glm::length(torque) / i.angular_stiffness).epsilon(1e-4));
    const Pose back = held_for(i, arm, {}, 2.0);
    CHECK(glm::length(back.position - meant.position) < 1e-9);
    CHECK(angle_between(back, meant) < 1e-9);
}

TEST_CASE("Arm: without a force a hand is where it means to be, at once and exactly") {
    Arm arm;
    const Pose pose = held_for({}, arm, {}, 0.5);
    CHECK(pose.position == meant.position);
    CHECK(angle_between(pose, meant) < 1e-12);
}

TEST_CASE("Arm: a free hand falls as its mass does at first, and swings as a damped spring does") {
    Impedance i;
    i.damping = 2.0 * 0.2 * std::sqrt(i.mass * i.stiffness);  // a fifth of critical
    Arm arm;
    const double force = 1.0, omega = std::sqrt(i.stiffness / i.mass), zeta = 0.2;
    double first = 0.0, most = 0.0;
    for (int k = 0; k < 400; ++k) {
        const Pose pose = follow(i, arm, meant, {Vec3(force, 0, 0), Vec3(0.0)}, false, dt);
        const double x = pose.position.x - meant.position.x;
        if (k == 9) first = x;
        most = std::max(most, x);
    }
    CHECK(first == doctest::Approx(0.5 * force / i.mass * 1e-4).epsilon(0.2));
    // Overshoot of a step: 1 + exp(-pi zeta / sqrt(1 - zeta²)); an implicit step of a millisecond damps a
    // little.
    const double overshoot = 1.0 + std::exp(-pi * zeta / std::sqrt(1.0 - zeta * zeta));
    CHECK(most == doctest::Approx(force / i.stiffness * overshoot).epsilon(0.03));
    CHECK(omega * dt < 0.05);
}

TEST_CASE("Arm: a hand that reaches is not stronger than it is told to be") {
    Impedance i;
    Arm arm;
    // Ten newtons against a spring that gives six: it is carried off as four newtons carry a damped mass.
    held_for(i, arm, {Vec3(10.0, 0, 0), Vec3(0.0)}, 2.0);
    CHECK(arm.velocity.x == doctest::Approx((10.0 - i.force) / i.damping).epsilon(1e-3));
}

TEST_CASE(
    "Arm: what has hold of a nut gives way to nothing; what it was away fades; taking up moves nothing") {
    const Impedance i;
    Arm arm;
    const Pose pushed = held_for(i, arm, {Vec3(2.0, 0, 0), Vec3(0, 0.1, 0)}, 1.0);
    const Pose held = follow(i, arm, meant, {Vec3(20.0, 0, 0), Vec3(0, 2.0, 0)}, true, dt);
    CHECK(glm::length(held.position - pushed.position) < 1e-4);
    CHECK(glm::length(held_for(i, arm, {Vec3(20.0, 0, 0), Vec3(0.0)}, 2.0, true).position - meant.position) <
          1e-9);
    Arm other;
    take_up(other, pushed, meant);
    const Pose same = follow(i, other, meant, {}, false, 1e-9);
    CHECK(glm::length(same.position - pushed.position) < 1e-9);
    CHECK(angle_between(same, pushed) < 1e-9);
}

namespace {

// Hash of all that a hand does in the first half minute, led or not, on a device that gives so much force.
std::uint64_t hand_of(double force, bool guides) {
    const content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    force::OutputLimits device;
    device.force = force;
    device.torque = 0.1 * force;
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, device, 5, dt);
    servo::State state = servo::initial_state(setup);
    lesson::Lesson lesson = lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
    lesson.guides = guides;
    Operator hand(find_profile("clumsy").value(), 5, setup);
    std::uint64_t hash = 14695981039346656037ULL;
    while (lesson.due() != nullptr && state.tick < 30'000) {
        const servo::Input input = hand.act(setup, state, lesson);
        CHECK(input.guide == (guides ? static_cast<int>(lesson.due()->joint) : -1));
        const auto* bytes = reinterpret_cast<const unsigned char*>(&input.device);
        for (std::size_t i = 0; i < sizeof input.device; ++i) hash = (hash ^ bytes[i]) * 1099511628211ULL;
        lesson::observe(lesson, state, servo::tick(setup, state, input));
        lesson.events.clear();
    }
    return hash;
}

}  // namespace

TEST_CASE(
    "Arm: a hand knows that it is led by the force alone: on a dead device guiding changes no bit of what it "
    "does") {
    CHECK(hand_of(0.0, true) == hand_of(0.0, false));
    CHECK(hand_of(20.0, true) != hand_of(20.0, false));
}
