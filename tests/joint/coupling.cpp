// Single steps of the drive, the spring between hand and nut, and the limits of its range.

#include <doctest/doctest.h>

#include "haptics/joint/nut.hpp"
#include "tests/joint/support.hpp"

namespace joint_coupling_test {

using namespace bolt;
using namespace bolt::joint;

namespace {

NutDrive spring(double angle, double half_play, double stiffness = 2000.0) {
    NutDrive drive;
    drive.engaged = true;
    drive.angle = angle;
    drive.half_play = half_play;
    drive.stiffness = stiffness;
    return drive;
}

Resistance constant(double tighten, double loosen, double lead = 0.0) {
    Resistance r;
    r.tighten = tighten;
    r.loosen = loosen;
    r.lead_torque = lead;
    return r;
}

double stored(const NutDrive& drive, double nut) {
    const double gap = drive.angle - nut;
    return 0.5 * drive.stiffness * square(std::max(0.0, std::abs(gap) - drive.half_play));
}

}  // namespace

TEST_CASE("Hand and nut: friction acts in tightening below the lead torque, and in loosening above it") {
    const Resistance r = constant(100.0, -70.0, 20.0);  // N·m: friction 80 in tightening, 90 in loosening
    const double inertia = drive_inertia(2000.0, 1e-3);
    const std::pair<double, double> torques[] = {{0.0, -20.0 / 90.0},   {10.0, -10.0 / 90.0},
                                                 {20.0, 0.0},           {50.0, 30.0 / 80.0},
                                                 {-30.0, -50.0 / 90.0}, {99.0, 79.0 / 80.0}};
    for (const auto& row : torques) {
        const auto& torque = row.first;
        const auto& share = row.second;
        CAPTURE(torque);
        const NutStep step = step_nut(r, inertia, {}, spring(torque / 2000.0, 0.0), 1e-3);
        CHECK(step.nut.speed == 0.0);
        CHECK(step.torque == doctest::Approx(torque));
        CHECK(step.friction_share == doctest::Approx(share).epsilon(1e-9));
    }
}

TEST_CASE("Hand and nut: at the end of the bolt the nut stops and the hand winds up its spring") {
    const GroupParameters group = test::single(test::m16_flange_joint());
    std::vector<JointState> joints = initial_state(group, 1);
    for (int i = 1; i <= 100; ++i) {
        const double hand = -1e-3 * i;
        step_group(group, joints, 0, spring(hand, 0.01), 1e-3);
        REQUIRE(joints[0].nut.angle == 0.0);
        REQUIRE(joints[0].nut.speed == 0.0);
        // Below a few tenths of a newton metre the thread's drag may also hold the nut; the torque is the
        // same.
        REQUIRE(joints[0].torque == doctest::Approx(-2000.0 * std::max(0.0, -hand - 0.01)));
    }
}

TEST_CASE("Hand and nut: a nut that leaves the jaw face for the backlash stops at once") {
    for (const double dt : {2.5e-4, 1e-3, 4e-3}) {
        const double drag = 0.05;
        const NutStep step = step_nut(constant(drag, -drag), drive_inertia(2000.0, dt), {0.0, 1.0},
                                      spring(0.0, to_radians(2.5)), dt);
        CHECK(step.nut.angle == 0.0);
        CHECK(step.nut.speed == 0.0);
        CHECK(step.torque == 0.0);
    }
}

TEST_CASE(
    "Hand and nut: the drive returns no more energy than the hand put in, for a nearly free nut with wide "
    "play") {
    Random random(17);
    for (const double dt : {2.5e-4, 1e-3, 4e-3}) {
        for (int trial = 0; trial < 30; ++trial) {
            CAPTURE(dt);
            CAPTURE(trial);
            const double drag = std::pow(10.0, random.uniform(-4.0, -1.0));
            const Resistance r = constant(drag, -drag);
            const double frequency = random.uniform(0.5, 8.0), reach = random.uniform(0.02, 0.6);
            NutMotion nut;
            NutDrive drive = spring(0.0, to_radians(2.5));
            double given = 0.0;
            const double start = stored(drive, nut.angle);
            for (double t = dt; t < 3.0; t += dt) {
                const double hand = drive.angle;
                drive.angle = reach * std::sin(2.0 * pi * frequency * t);
                const NutStep step = step_nut(r, drive_inertia(2000.0, dt), nut, drive, dt);
                given += step.torque * (drive.angle - hand) - step.torque * (step.nut.angle - nut.angle);
                nut = step.nut;
                REQUIRE(given >= stored(drive, nut.angle) - start - 1e-9);
            }
        }
    }
}

TEST_CASE("Hand and nut: a jaw at rest does not hold back a fast nut") {
    for (const double sign : {1.0, -1.0}) {
        const double dt = 1e-3, wound = 1e-4, play = to_radians(2.5);
        const NutStep step = step_nut(constant(0.05, -0.05), drive_inertia(2000.0, dt), {0.0, 20.0 * sign},
                                      spring(sign * (play + wound), play), dt);
        CHECK(step.torque == 0.0);
        CHECK(step.nut.speed * sign > 19.0);
    }
}

TEST_CASE("Hand and nut: fingers slow a faster nut with their limit torque in both directions") {
    for (const double sign : {1.0, -1.0}) {
        NutDrive fingers = spring(0.0, 0.0, 5.0);
        fingers.torque_limit = 0.03;
        // 1e-5 kg m2 at 20 rad/s over 1 ms is 0.2 N m, less 0.02 of drag and 0.03 of the fingers: 15 rad/s.
        const NutStep step = step_nut(constant(0.02, -0.02), 1e-5, {0.0, 20.0 * sign}, fingers, 1e-3);
        CHECK(step.slipped);
        CHECK(step.torque == doctest::Approx(-0.03 * sign));
        CHECK(step.nut.speed == doctest::Approx(15.0 * sign));
    }
}

}  // namespace joint_coupling_test
