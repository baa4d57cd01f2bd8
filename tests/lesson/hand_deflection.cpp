// The hand of a simulated trainee under forces, against closed forms.
#include "game/trainees/human_model.hpp"

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "game/lesson/lesson.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using namespace bolt::trainees;

namespace {

constexpr double dt = 1e-3;
const Pose intended{{0.1, -0.2, 0.3}, rotation(Vec3(0.3, -0.2, 0.9))};

Pose held_for(const Impedance& i, HandDeflection& deflection, const force::OutputCommand& felt,
              double seconds, bool grips = false) {
    Pose pose = intended;
    for (int k = 0; k < static_cast<int>(seconds / dt); ++k)
        pose = step_deflection(i, deflection, intended, felt, grips, dt);
    return pose;
}

double angle_between(const Pose& a, const Pose& b) {
    return glm::length(turn_between(b.orientation, a.orientation));
}

}  // namespace

TEST_CASE("Hand deflection: a steady force deflects it by F/k and a torque by T/k, and it returns") {
    const Impedance i;
    HandDeflection deflection;
    const Vec3 force(0.6, -1.2, 0.3), torque(0.02, 0.05, -0.01);
    const Pose pushed = held_for(i, deflection, {force, torque}, 2.0);
    CHECK(glm::length(pushed.position - intended.position - force / i.stiffness) < 1e-6);
    CHECK(angle_between(pushed, intended) ==
          doctest::Approx(glm::length(torque) / i.angular_stiffness).epsilon(1e-4));
    const Pose back = held_for(i, deflection, {}, 2.0);
    CHECK(glm::length(back.position - intended.position) < 1e-9);
    CHECK(angle_between(back, intended) < 1e-9);
}

TEST_CASE("Hand deflection: without a force its pose is exactly the intended one") {
    HandDeflection deflection;
    const Pose pose = held_for({}, deflection, {}, 0.5);
    CHECK(pose.position == intended.position);
    CHECK(angle_between(pose, intended) < 1e-12);
}

TEST_CASE("Hand deflection: a free hand first accelerates as its mass, then oscillates as a damped spring") {
    Impedance i;
    i.damping = 2.0 * 0.2 * std::sqrt(i.mass * i.stiffness);  // a fifth of critical
    HandDeflection deflection;
    const double force = 1.0, omega = std::sqrt(i.stiffness / i.mass), zeta = 0.2;
    double first = 0.0, most = 0.0;
    for (int k = 0; k < 400; ++k) {
        const Pose pose = step_deflection(i, deflection, intended, {Vec3(force, 0, 0), Vec3(0.0)}, false, dt);
        const double x = pose.position.x - intended.position.x;
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

TEST_CASE("Hand deflection: the force of a reaching hand is limited") {
    Impedance i;
    HandDeflection deflection;
    // 10 N against a spring limited to 6 N: the hand moves as a damped mass under 4 N.
    held_for(i, deflection, {Vec3(10.0, 0, 0), Vec3(0.0)}, 2.0);
    CHECK(deflection.velocity.x == doctest::Approx((10.0 - i.max_force) / i.damping).epsilon(1e-3));
}

TEST_CASE(
    "Hand deflection: a hand that holds a nut does not deflect, an earlier deflection decays, and gripping "
    "causes no jump") {
    const Impedance i;
    HandDeflection deflection;
    const Pose pushed = held_for(i, deflection, {Vec3(2.0, 0, 0), Vec3(0, 0.1, 0)}, 1.0);
    const Pose held = step_deflection(i, deflection, intended, {Vec3(20.0, 0, 0), Vec3(0, 2.0, 0)}, true, dt);
    CHECK(glm::length(held.position - pushed.position) < 1e-4);
    CHECK(glm::length(held_for(i, deflection, {Vec3(20.0, 0, 0), Vec3(0.0)}, 2.0, true).position -
                      intended.position) < 1e-9);
    HandDeflection other;
    reset_deflection(other, pushed, intended);
    const Pose same = step_deflection(i, other, intended, {}, false, 1e-9);
    CHECK(glm::length(same.position - pushed.position) < 1e-9);
    CHECK(angle_between(same, pushed) < 1e-9);
}

namespace {

// Hash of a hand's motion in the first 30 s, guided or not, on a device with this maximum force in N.
std::uint64_t motion_hash(double force, bool guides) {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    force::OutputLimits device;
    device.force = force;
    device.torque = 0.1 * force;
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, device, 5, dt);
    servo::State state = servo::initial_state(setup);
    world::World world = test::make_world(state);
    lesson::Lesson lesson = lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
    lesson.guides = guides;
    SimulatedTrainee hand(find_profile("clumsy").value(), 5, setup);
    std::uint64_t hash = 14695981039346656037ULL;
    while (lesson.due() != nullptr && state.tick < 30'000) {
        const servo::TickInput input = hand.act(setup, state, lesson);
        CHECK(input.guided_joint == (guides ? static_cast<int>(lesson.due()->joint) : -1));
        const auto* bytes = reinterpret_cast<const unsigned char*>(&input.commanded_tool);
        for (std::size_t i = 0; i < sizeof input.commanded_tool; ++i)
            hash = (hash ^ bytes[i]) * 1099511628211ULL;
        test::observe_tick(lesson, world, state, servo::tick(setup, state, input));
        lesson.events.clear();
    }
    return hash;
}

}  // namespace

TEST_CASE(
    "Hand deflection: guidance acts through the force alone: on a device without force it changes no bit of "
    "the motion") {
    CHECK(motion_hash(0.0, true) == motion_hash(0.0, false));
    CHECK(motion_hash(20.0, true) != motion_hash(20.0, false));
}
