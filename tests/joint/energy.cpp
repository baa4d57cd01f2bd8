// Invariants over random joints and motions: a closed cycle of the nut generates no energy, the clamp force
// is never negative, irreversible quantities never decrease, and equal runs are equal bit for bit.
#include <doctest/doctest.h>

#include "tests/joint/support.hpp"

using namespace bolt;
using namespace bolt::joint;

namespace {

struct Cycle {
    double work = 0.0;     // J put in over the closed cycle
    double largest = 0.0;  // maximum of |torque · dθ|, for scale
    double friction = 0.0;
};

Cycle random_cycle(const GroupParameters& group, Random& random, bool take_friction_off) {
    std::vector<JointState> joints = initial_state(group, 1);
    const MechanisticParameters& p = group.joints[0];
    const double snug = p.start_gap / p.levers.lead;
    const double span = to_radians(random.uniform(10.0, 250.0));
    Cycle cycle;
    const double dt = 1e-3;
    double angle = 0.0;
    const auto go = [&](double to) {
        const double step = to_radians(random.uniform(0.02, 0.4));
        const double sign = to > angle ? 1.0 : -1.0;
        const int n = static_cast<int>(std::abs(to - angle) / step) + 1;
        const double from = angle;
        for (int i = 1; i <= n; ++i) {
            const MechanisticState before = joints[0].mechanistic;
            const double next = from + (to - from) * i / n;
            turn_nut(group, joints, 0, next, sign, dt);
            const MechanisticState& s = joints[0].mechanistic;
            REQUIRE(s.clamp >= 0.0);
            REQUIRE(std::isfinite(joints[0].torque));
            REQUIRE(s.plastic >= before.plastic);
            REQUIRE(s.embedding >= before.embedding);
            REQUIRE(s.stripped >= before.stripped);
            double torque = joints[0].torque;
            if (take_friction_off) torque = resistance(p, s).lead_torque;
            // Rectangle rule with the torque at the end of the step.
            const double work = torque * (next - angle);
            cycle.work += work;
            cycle.largest = std::max(cycle.largest, std::abs(work));
            angle = next;
        }
    };
    const int legs = 1 + static_cast<int>(random.bits() % 5);
    for (int leg = 0; leg < legs; ++leg) go(snug + random.uniform(-0.2, 1.0) * span);
    go(0.0);
    return cycle;
}

}  // namespace

TEST_CASE("Energy: no closed cycle of 300 random joints and motions generates energy") {
    Random random(11);
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(trial);
        const GroupParameters group = test::single(test::random_joint(random));
        const Cycle cycle = random_cycle(group, random, false);
        CHECK(cycle.work >= 0.0);
    }
}

TEST_CASE("Energy: plasticity and embedding without friction only dissipate") {
    // The clamp force is sampled at the end of each step, so the sum over a closed elastic cycle has an error
    // of the order of a step. The tolerance is the largest work of one step.
    Random random(12);
    for (int trial = 0; trial < 200; ++trial) {
        CAPTURE(trial);
        const GroupParameters group = test::single(test::random_joint(random));
        const Cycle cycle = random_cycle(group, random, true);
        CHECK(cycle.work >= -cycle.largest);
    }
}

TEST_CASE("Energy: the check detects friction of the wrong sign") {
    Random random(11);
    GroupParameters group = test::single(test::m16_flange_joint());
    group.joints[0].levers.thread *= -1.0;
    group.joints[0].levers.bearing *= -1.0;
    CHECK(random_cycle(group, random, false).work < 0.0);
}

TEST_CASE("Energy: equal runs are equal bit for bit") {
    const auto run = [] {
        Random random(21);
        std::vector<double> out;
        for (int trial = 0; trial < 20; ++trial) {
            const GroupParameters group = test::single(test::random_joint(random));
            std::vector<JointState> joints = initial_state(group, 1);
            for (int i = 0; i < 2000; ++i) {
                NutDrive drive;
                drive.engaged = true;
                drive.angle = 2e-3 * i + 0.1 * std::sin(0.05 * i);
                drive.stiffness = 500.0;
                drive.half_play = 0.01;
                step_group(group, joints, 0, drive, 1e-3);
            }
            out.push_back(joints[0].torque);
            out.push_back(joints[0].clamp);
            out.push_back(joints[0].nut.angle);
        }
        return out;
    };
    const auto a = run(), b = run();
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == b[i]);
}

TEST_CASE("Energy: jumps of many turns and reversals every step give finite results") {
    Random random(31);
    for (int trial = 0; trial < 60; ++trial) {
        CAPTURE(trial);
        const GroupParameters group = test::single(test::random_joint(random));
        std::vector<JointState> joints = initial_state(group, 1);
        for (int i = 0; i < 400; ++i) {
            NutDrive drive;
            drive.engaged = random.chance(0.9);
            drive.angle = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-3.0, 3.0));
            drive.stiffness = std::pow(10.0, random.uniform(0.0, 5.0));
            drive.half_play = random.uniform(0.0, 0.05);
            drive.torque_limit = random.chance(0.3) ? random.uniform(0.1, 5.0) : 0.0;
            step_group(group, joints, 0, drive, 1e-3);
            REQUIRE(std::isfinite(joints[0].torque));
            REQUIRE(std::isfinite(joints[0].clamp));
            REQUIRE(joints[0].clamp >= 0.0);
            REQUIRE(std::isfinite(joints[0].nut.angle));
        }
    }
}
