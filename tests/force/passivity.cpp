// The energy balance of the port for motions with known work, and the limits of the controller.
#include "haptics/force/output_stage.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "engine/base/random.hpp"

namespace force_passivity_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;

OutputLimits no_delay() {
    OutputLimits limits;
    limits.delay = 0;
    return limits;
}

Motion moved(const Vec3& shift, const Vec3& turn = Vec3(0.0)) {
    return {shift, turn, shift / dt, turn / dt, true};
}

}  // namespace

TEST_CASE("Passivity: the balance is the work of the applied force and torque") {
    Random random(8);
    const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    for (int delay = 0; delay < 4; ++delay) {
        OutputLimits limits;
        limits.delay = delay;
        PassivityState s;
        std::vector<OutputCommand> sent(4);
        double work = 0.0;
        for (int i = 0; i < 200; ++i) {
            const Motion motion = moved(1e-3 * any(), 1e-3 * any());
            const OutputCommand& had = sent[sent.size() - 1 - static_cast<std::size_t>(delay)];
            work += glm::dot(had.force, motion.shift) + glm::dot(had.torque, motion.rotation);
            add_applied_work(limits, s, motion, 1.0);
            REQUIRE(s.balance == doctest::Approx(-work));
            sent.push_back({any(), any()});
            record_sent(s, sent.back());
        }
    }
}

TEST_CASE("Passivity: with a sample every third tick the motion is charged with the mean applied force") {
    PassivityState s;
    const Vec3 forces[] = {Vec3(1, 0, 0), Vec3(4, 0, 0), Vec3(7, 0, 0)};
    for (int i = 0; i < 3; ++i) {
        record_sent(s, {forces[i], Vec3(0.0)});
        add_applied_work(no_delay(), s, i == 2 ? moved(Vec3(0.01, 0, 0)) : Motion{}, 1.0);
    }
    CHECK(s.balance == doctest::Approx(-0.04));
}

TEST_CASE("Passivity: an ideal spring keeps the balance at zero and causes no damping") {
    // Fine steps, because the energy that sampling generates is proportional to the step.
    const double K = 1000.0, step = 1e-6;
    PassivityState s;
    double x = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        const double shift = i < 10'000 ? step : -step;
        x += shift;
        add_applied_work(no_delay(), s, moved(Vec3(-shift, 0, 0)), 1.0);
        const ForceRequest request{{Vec3(K * x, 0, 0), Vec3(0.0)}, 0.5 * K * x * x};
        const OutputCommand out = control_passivity(no_delay(), s, {}, request, 1.0, 1.0, dt);
        record_sent(s, out);
        REQUIRE(std::abs(s.balance) < 0.5 * K * step * step * 20'000);
    }
    CHECK(std::abs(s.balance) < 0.02e-3);
}

TEST_CASE("Passivity: a sampled spring generates K v² T² / 2 per tick, which the controller removes") {
    const double K = 1000.0, v = 0.2;
    const auto press = [&](double damping) {
        OutputLimits limits = no_delay();
        limits.damping = damping;
        PassivityState s;
        double x = 0.0;
        const int ticks = 50;
        for (int i = 0; i < ticks; ++i) {
            x += v * dt;
            const Motion motion = moved(Vec3(-v * dt, 0, 0));
            add_applied_work(limits, s, motion, 1.0);
            const ForceRequest request{{Vec3(K * x, 0, 0), Vec3(0.0)}, 0.5 * K * x * x};
            record_sent(s, control_passivity(limits, s, motion, request, 1.0, 1.0, dt));
        }
        return s.balance / ticks;
    };
    CHECK(press(0.0) == doctest::Approx(-0.5 * K * v * v * dt * dt).epsilon(1e-6));
    CHECK(press(20.0) > -0.05 * 0.5 * K * v * v * dt * dt);
}

TEST_CASE("Passivity: damping stays below nine tenths of the device's limit and opposes the motion") {
    OutputLimits limits;
    PassivityState s;
    s.balance = -10.0;
    const Motion motion = moved(Vec3(3e-4, 0, -4e-4), Vec3(0, 2e-3, 0));
    OutputCommand out;
    for (int i = 0; i < 20; ++i) {  // the damping is complete within 10 ms
        const double before = s.damping;
        out = control_passivity(limits, s, motion, {}, 1.0, 1.0, dt);
        CHECK(s.damping - before <= damping_rise_rate * dt + 1e-12);
    }
    CHECK(glm::length(out.force + 0.9 * limits.damping * motion.velocity) < 1e-12);
    CHECK(glm::length(out.torque + 0.9 * limits.angular_damping * motion.angular_velocity) < 1e-12);
    CHECK(s.damping == 1.0);
}

TEST_CASE("Passivity: the removed power is the deficit over one tick") {
    const OutputLimits limits;
    PassivityState s;
    s.balance = -1e-4;
    const Motion motion = moved(Vec3(1e-3, 0, 0), Vec3(0, 1e-3, 0));
    s.damping = 1.0;
    for (int i = 0; i < 60; ++i) control_passivity(limits, s, motion, {}, 1.0, 1.0, dt);
    s.removed = 0.0;
    const OutputCommand out = control_passivity(limits, s, motion, {}, 1.0, 1.0, dt);
    const double power =
        -glm::dot(out.force, motion.velocity) - glm::dot(out.torque, motion.angular_velocity);
    CHECK(power * dt == doctest::Approx(1e-4));
    CHECK(s.removed == doctest::Approx(1e-4));
    CHECK(s.damping < 1.0);
}

TEST_CASE("Passivity: credit from dissipation decays") {
    const OutputLimits limits = no_delay();
    PassivityState s;
    record_sent(s, {Vec3(-10, 0, 0), Vec3(0.0)});
    for (int i = 0; i < 1000; ++i) {
        add_applied_work(limits, s, moved(Vec3(1e-3, 0, 0)), 1.0);  // the device dissipates 10 mJ per tick
        control_passivity(limits, s, {}, {}, 1.0, 1.0, dt);
    }
    CHECK(s.balance <= max_credit);
    CHECK(s.balance > 0.9 * max_credit);
    for (int i = 0; i < 100; ++i) control_passivity(limits, s, {}, {}, 1.0, 1.0, dt);
    CHECK(s.balance < 0.05 * max_credit);  // the credit decays
}

TEST_CASE("Passivity: injected energy is no deficit; stored energy that grows without work is one") {
    const OutputLimits limits;
    PassivityState s;
    ForceRequest request;
    request.stored_energy = 5e-3;
    request.injected_energy = 5e-3;
    control_passivity(limits, s, {}, request, 1.0, 1.0, dt);
    CHECK(s.balance == doctest::Approx(0.0));
    request.stored_energy = 8e-3;
    request.injected_energy = 0.0;
    control_passivity(limits, s, {}, request, 1.0, 1.0, dt);
    CHECK(s.balance == doctest::Approx(-3e-3));
}

TEST_CASE(
    "Passivity: an excessive request is scaled down in force and torque alike, and its energy accordingly") {
    const OutputLimits limits;
    PassivityState s;
    ForceRequest request{{Vec3(2.0 * limits.force, 0, 0), Vec3(0, 1, 0)}, 1.0};
    const OutputCommand out = control_passivity(limits, s, {}, request, 1.0, 1.0, dt);
    CHECK(out.force.x == doctest::Approx(limits.force));
    CHECK(out.torque.y == doctest::Approx(0.5));
    CHECK(s.stored_energy == doctest::Approx(0.75));  // a spring held at half of its force

    request = {{Vec3(10, 0, 0), Vec3(0, 4.0 * limits.torque, 0)}, 0.0};
    CHECK(control_passivity(limits, s, {}, request, 1.0, 1.0, dt).force.x == doctest::Approx(2.5));
    OutputLimits without = limits;
    without.torque = 0.0;
    CHECK(control_passivity(without, s, {}, request, 1.0, 1.0, dt).force.x == doctest::Approx(10.0));
}

TEST_CASE("Passivity: stored energy enters with the ramp as injected energy") {
    const OutputLimits limits;
    PassivityState s;
    const ForceRequest request{{}, 2e-3};
    for (int i = 1; i <= 10; ++i) control_passivity(limits, s, {}, request, 0.1 * i, 0.1 * (i - 1), dt);
    CHECK(s.balance == doctest::Approx(0.0));
    CHECK(s.stored_energy == doctest::Approx(2e-3));
}

TEST_CASE("Passivity: a component that the device does not render does not reduce the other") {
    for (const bool torque : {true, false}) {
        OutputLimits limits;
        (torque ? limits.force : limits.torque) = 0.0;
        PassivityState s;
        const ForceRequest request{{Vec3(5, 0, 0), Vec3(0, 1, 0)}, 10.0, 0.0};
        const OutputCommand out = control_passivity(limits, s, moved(Vec3(0.0)), request, 1.0, 1.0, dt);
        if (torque) CHECK(out.torque.y == doctest::Approx(1.0));
        if (!torque) CHECK(out.force.x == doctest::Approx(5.0));
    }
}

}  // namespace force_passivity_test
