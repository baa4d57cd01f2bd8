// The trial of an arm's stiffness, in virtual time on simulated arms with a hand.
#include "haptics/station/stiffness_trial.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <deque>

#include "haptics/device/simulated_arm.hpp"

namespace station_stiffness_trial_test {

using namespace bolt;
using namespace bolt::station;

namespace {

constexpr double dt = 1e-3;  // s

device::Description announced() {
    device::Description d;
    d.name = "an arm";
    d.renders = {true, true, true, false, false, false};
    d.limits.force = 12.0;
    d.limits.torque = 0.0;
    d.limits.stiffness = 5000.0;
    d.limits.damping = 15.0;
    return d;
}

device::HandAndArmParameters arm_with(double mass, double damping) {
    device::HandAndArmParameters p;
    p.mass = mass;
    p.damping = damping;
    return p;
}

// A trial on an arm whose forces arrive `late` ticks later than it announces.
struct Bench {
    device::ArmModel arm;
    StiffnessTrial trial;
    double time = 0.0;           // s
    double largest_force = 0.0;  // N
    int ticks_per_sample = 1;

    explicit Bench(const device::HandAndArmParameters& parameters, int late = 0,
                   const device::Description& description = announced())
        : trial(begin_stiffness_trial(description)), under_way_(static_cast<std::size_t>(late)) {
        arm.parameters = parameters;
        arm.parameters.delay = description.limits.delay;
    }
    // Returns the force, N.
    double tick(bool enabled) {
        force::DeviceInput input;
        input.fresh = ticks_ % ticks_per_sample == 0;
        if (input.fresh) sampled_ = device::encoder_pose(arm);
        ++ticks_;
        input.pose = sampled_;
        input.dead_man = enabled;
        const force::OutputCommand command = step(trial, input, dt);
        under_way_.push_back(command);
        device::step(arm, under_way_.front(), dt);
        under_way_.pop_front();
        time += dt;
        largest_force = std::max(largest_force, glm::length(command.force));
        return glm::length(command.force);
    }

  private:
    std::deque<force::OutputCommand> under_way_;
    Pose sampled_;
    int ticks_ = 0;
};

struct Measured {
    StiffnessTrial trial;
    double largest_force = 0.0;  // N
    double seconds = 0.0;
};

Measured measure(const device::HandAndArmParameters& parameters, int late,
                 const device::Description& description = announced()) {
    Bench bench(parameters, late, description);
    while (bench.trial.end == TrialEnd::none && bench.time < 60.0) bench.tick(true);
    return {bench.trial, bench.largest_force, bench.time};
}

}  // namespace

TEST_CASE("Stiffness trial: a good arm renders all that it announces, with a fifth of its force") {
    const Measured m = measure(arm_with(0.3, 12.0), 0);
    CHECK(m.trial.end == TrialEnd::rendered_as_reported);
    CHECK(m.trial.stable == 5000.0);
    CHECK(m.largest_force <= 0.2 * 12.0 + 1e-9);
    CHECK(m.largest_force > 1.0);
    CHECK(m.seconds == doctest::Approx(0.5 + stiffness_levels * stiffness_level_time).epsilon(0.01));
    REQUIRE(median_response(m.trial));
    CHECK(*median_response(m.trial) <= 5e-3);
}

TEST_CASE("Stiffness trial: levels and responses last as long on an arm that sends every second tick") {
    Bench every_tick(arm_with(0.3, 12.0), 4), every_second(arm_with(0.3, 12.0), 4);
    every_second.ticks_per_sample = 2;
    for (Bench* bench : {&every_tick, &every_second})
        while (bench->trial.level == 0 && bench->time < 5.0) bench->tick(true);
    CHECK(every_second.time == doctest::Approx(every_tick.time).epsilon(0.01));
    REQUIRE(every_second.trial.responses.size() == 1);
    CHECK(every_second.trial.responses[0] >= every_tick.trial.responses[0]);
    CHECK(every_second.trial.responses[0] <= every_tick.trial.responses[0] + 2.0 * dt);
}

TEST_CASE("Stiffness trial: the later the forces arrive, the lower the figure, and the response shows it") {
    double before = 1e9, response_before = 0.0;
    for (const int late : {0, 2, 4, 8}) {
        CAPTURE(late);
        const Measured m = measure(arm_with(0.3, 5.0), late);
        CHECK(m.trial.stable < before);
        CHECK((m.trial.end == TrialEnd::rendered_as_reported) == (late == 0));
        before = m.trial.stable;
        const double response = median_response(m.trial).value_or(1.0);
        CHECK(response > response_before);
        response_before = response;
    }
}

TEST_CASE("Stiffness trial: a sluggish arm gets a lower figure than a damped one") {
    const double damped = measure(arm_with(0.6, 12.0), 1).trial.stable;
    const double sluggish = measure(arm_with(0.6, 2.0), 1).trial.stable;
    CHECK(damped == 5000.0);
    CHECK(sluggish < 0.5 * damped);
}

TEST_CASE("Stiffness trial: a slow swing that does not die away is seen by its energy") {
    device::HandAndArmParameters heavy = arm_with(3.0, 0.0);
    heavy.stiffness = 20.0;  // a hand that hardly holds it
    device::Description d = announced();
    d.limits.damping = 0.0;
    const Measured m = measure(heavy, 10, d);
    CHECK(m.trial.end == TrialEnd::energy);
    CHECK(m.trial.stable < 2500.0);
}

TEST_CASE("Stiffness trial: a hand that trembles and wanders does not make an arm unstable") {
    Bench bench(arm_with(0.3, 12.0));
    while (bench.trial.end == TrialEnd::none && bench.time < 60.0) {
        // 0.2 mm at 9 Hz, and 1 cm/s to and fro.
        const double wander = 0.01 * std::abs(std::fmod(bench.time, 2.0) - 1.0);
        bench.arm.intention.position = Vec3(wander, 1e-4 * std::sin(2.0 * pi * 9.0 * bench.time), 0.0);
        bench.tick(true);
    }
    CHECK(bench.trial.end == TrialEnd::rendered_as_reported);
}

TEST_CASE("Stiffness trial: it renders only while the button is held, and goes on when it is held again") {
    Bench bench(arm_with(0.3, 12.0));
    for (int i = 0; i < 1000; ++i) CHECK(bench.tick(false) == 0.0);
    for (int i = 0; i < 2800; ++i) bench.tick(true);
    const int reached = bench.trial.level;
    CHECK(reached == 2);
    for (int i = 0; i < 20; ++i) bench.tick(false);
    for (int i = 0; i < 1000; ++i) CHECK(bench.tick(false) == 0.0);
    CHECK(bench.trial.level == reached);
    for (int i = 0; i < 20000 && bench.trial.end == TrialEnd::none; ++i) bench.tick(true);
    CHECK(bench.trial.end == TrialEnd::rendered_as_reported);
    for (int i = 0; i < 20; ++i) bench.tick(true);
    CHECK(bench.tick(true) == 0.0);
}

TEST_CASE("Stiffness trial: a pose that jumps ends it without force") {
    Bench bench(arm_with(0.3, 12.0));
    for (int i = 0; i < 2000; ++i) bench.tick(true);
    CHECK(bench.trial.end == TrialEnd::none);
    bench.arm.pose.position.x += 0.2;
    bench.tick(true);
    CHECK(bench.trial.end == TrialEnd::fault);
    CHECK(bench.trial.fault == force::Fault::jumped);
    for (int i = 0; i < 20; ++i) bench.tick(true);
    CHECK(bench.tick(true) == 0.0);
}

TEST_CASE("Stiffness trial: an arm that renders along one axis is pushed along it") {
    device::Description d = announced();
    d.renders = {false, true, false, false, false, false};
    CHECK(begin_stiffness_trial(d).direction == Vec3(0, 1, 0));
    CHECK(measure(arm_with(0.3, 12.0), 0, d).trial.end == TrialEnd::rendered_as_reported);
}

}  // namespace station_stiffness_trial_test
