#include "haptics/joint/nut.hpp"

#include <doctest/doctest.h>

#include "tests/joint/support.hpp"

namespace joint_nut_test {

using namespace bolt;
using namespace bolt::joint;

namespace {

NutDrive spring(double angle, double half_play = 0.0) {
    NutDrive drive;
    drive.engaged = true;
    drive.angle = angle;
    drive.stiffness = 2000.0;
    drive.half_play = half_play;
    return drive;
}

// A nut tightened to about 40 kN.
struct Tight {
    GroupParameters group = test::single([] {
        JointDesign d = test::m16_flange_joint();
        d.running_drag = 0.0;
        d.embedding_time = 1e9;
        return d;
    }());
    std::vector<JointState> joints = initial_state(group, 1);
    Tight() {
        while (joints[0].clamp < 40e3) turn_nut(group, joints, 0, joints[0].nut.angle + 1e-4, 1.0, 1e-3);
        joints[0].nut.speed = 0.0;
        for (int i = 0; i < 3000; ++i) step_group(group, joints, -1, NutDrive{}, 1e-3);
    }
};

}  // namespace

TEST_CASE("Nut: an adaptor in line lengthens the lever of a torque wrench, at a right angle it does not") {
    // The scale is set to T L / (L + e).
    CHECK(206.0 / joint::adaptor_ratio(0.4, 0.06) == doctest::Approx(206.0 * 400.0 / 460.0));
    CHECK(joint::adaptor_ratio(0.4, 0.06, pi / 2.0) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(joint::adaptor_ratio(0.4, 0.06, pi / 4.0) == doctest::Approx(1.10607).epsilon(1e-5));
    CHECK(joint::adaptor_ratio(0.4, 0.0) == 1.0);
}

TEST_CASE("Nut: the angle is unchanged to the bit until the torque exceeds the resistance") {
    Tight tight;
    const double stands_at = tight.joints[0].nut.angle;
    const Resistance r = resistance(tight.group, 0, tight.joints[0]);
    double last = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        step_group(tight.group, tight.joints, 0, spring(stands_at + 1e-5 * i), 1e-3);
        if (tight.joints[0].nut.angle != stands_at) break;
        last = tight.joints[0].torque;
    }
    CHECK(last == doctest::Approx(r.tighten).epsilon(1e-3));
    CHECK(last <= r.tighten);
}

TEST_CASE("Nut: a constant torque below the resistance never moves it") {
    Tight tight;
    const double stands_at = tight.joints[0].nut.angle;
    const Resistance r = resistance(tight.group, 0, tight.joints[0]);
    for (const double share : {0.99, 0.5, -0.5, -0.99}) {
        const double torque = share > 0 ? share * r.tighten : -share * r.loosen;
        for (int i = 0; i < 2000; ++i) {
            step_group(tight.group, tight.joints, 0, spring(stands_at + torque / 2000.0), 1e-3);
            REQUIRE(tight.joints[0].nut.angle == stands_at);
            REQUIRE(tight.joints[0].nut.speed == 0.0);
        }
        CHECK(tight.joints[0].torque == doctest::Approx(torque));
    }
}

TEST_CASE("Nut: a slowly turned nut follows the hand at exactly the running torque") {
    Tight tight;
    double hand = tight.joints[0].nut.angle;
    for (int i = 0; i < 3000; ++i) {
        hand += 1e-4;
        step_group(tight.group, tight.joints, 0, spring(hand), 1e-3);
    }
    const Resistance r = resistance(tight.group, 0, tight.joints[0]);
    CHECK(tight.joints[0].torque == doctest::Approx(r.tighten).epsilon(0.005));
    CHECK(tight.joints[0].nut.speed == doctest::Approx(0.1).epsilon(0.1));
    CHECK(tight.joints[0].mechanistic.friction_share == 1.0);
}

TEST_CASE("Nut: tension does not unscrew a released nut") {
    Tight tight;
    const double stands_at = tight.joints[0].nut.angle;
    for (int i = 0; i < 10'000; ++i) step_group(tight.group, tight.joints, 0, NutDrive{}, 1e-3);
    CHECK(tight.joints[0].nut.angle == stands_at);
    CHECK(tight.joints[0].torque == 0.0);
}

TEST_CASE("Nut: the torque is zero within the backlash and rises continuously from its edge") {
    Tight tight;
    const double nut = tight.joints[0].nut.angle, play = 0.015;
    double last = 0.0;
    for (int i = -200; i <= 400; ++i) {
        const double hand = nut + 1e-4 * i;
        step_group(tight.group, tight.joints, 0, spring(hand, play), 1e-3);
        if (tight.joints[0].nut.angle != nut) break;
        if (std::abs(hand - nut) <= play) CHECK(tight.joints[0].torque == 0.0);
        CHECK(std::abs(tight.joints[0].torque - last) <=
              2000.0 * 1.01e-4 + 2000.0 * (i == -200 ? 0.005 : 0.0) + 1e-9);
        last = tight.joints[0].torque;
    }
}

TEST_CASE("Nut: fingers slip at their limit torque") {
    Tight tight;
    NutDrive fingers = spring(tight.joints[0].nut.angle + 1.0);
    fingers.stiffness = 5.0;
    fingers.torque_limit = 0.8;
    step_group(tight.group, tight.joints, 0, fingers, 1e-3);
    CHECK(tight.joints[0].torque == doctest::Approx(0.8));
    CHECK(tight.joints[0].nut.speed == 0.0);
}

TEST_CASE("Nut: a jaw pushes and never pulls, for any motion of the nut") {
    Random random(9);
    Tight tight;
    double hand = tight.joints[0].nut.angle;
    for (int i = 0; i < 50'000; ++i) {
        hand += random.normal() * 2e-3;
        const double before = tight.joints[0].nut.angle;
        step_group(tight.group, tight.joints, 0, spring(hand, 0.01), 1e-3);
        const double torque = tight.joints[0].torque;
        REQUIRE(torque * (hand - before) >= 0.0);
    }
}

TEST_CASE("Nut: the wrench generates no energy over any motion of the hand") {
    // The work of the drive on the nut exceeds the energy that the joint can store.
    Random random(10);
    for (int trial = 0; trial < 20; ++trial) {
        Tight tight;
        const double elastic = 0.5 * 40e3 * 40e3 * tight.group.joints[0].seat.compliance + 10.0;
        double hand = tight.joints[0].nut.angle, work = 0.0, drift = 0.0;
        for (int i = 0; i < 5000; ++i) {
            drift = 0.99 * drift + random.normal() * 2e-4;
            hand += drift;
            const double before = tight.joints[0].nut.angle;
            step_group(tight.group, tight.joints, 0, spring(hand, 0.01), 1e-3);
            work += tight.joints[0].torque * (tight.joints[0].nut.angle - before);
            REQUIRE(work > -elastic);
        }
    }
}

TEST_CASE("Nut: the same pull gives the same torque at 1 and 4 kHz") {
    const auto peak = [](double dt) {
        Tight tight;
        double hand = tight.joints[0].nut.angle, highest = 0.0;
        for (double t = 0.0; t < 2.0; t += dt) {
            hand += 0.2 * dt;
            step_group(tight.group, tight.joints, 0, spring(hand, 0.01), dt);
            highest = std::max(highest, tight.joints[0].torque);
        }
        return highest;
    };
    CHECK(peak(1e-3) == doctest::Approx(peak(2.5e-4)).epsilon(0.005));
}

}  // namespace joint_nut_test
