// Joints whose held part can turn: the torques on it, and nut and bolt that turn together.
#include <doctest/doctest.h>

#include <limits>

#include "tests/joint/support.hpp"

namespace counter_hold_test {

using namespace bolt;
using namespace bolt::joint;

namespace {

constexpr double dt = 1e-3;
constexpr double held = std::numeric_limits<double>::infinity();

JointDesign design_with(double mu, CounterHold hold) {
    JointDesign d = test::m16_flange_joint(mu);
    d.counter_hold = hold;
    d.washer_under_head = false;
    d.embedding_time = 1e9;
    return d;
}

// A joint that a wrench turns at 20°/s.
struct Pull {
    GroupParameters group;
    std::vector<JointState> joints;
    NutDrive drive;

    explicit Pull(const JointDesign& design) : group(test::single(design)), joints(initial_state(group, 1)) {
        drive.engaged = true;
        drive.stiffness = 2000.0;
    }
    [[nodiscard]] const JointState& joint() const { return joints[0]; }
    void step(double speed, double hold) {
        drive.angle += to_radians(speed) * dt;
        drive.held_part_torque = hold;
        step_group(group, joints, 0, drive, dt);
    }
    void tighten_to(double clamp) {
        for (int i = 0; i < 100'000 && joint().clamp < clamp; ++i) step(20.0, held);
    }
};

bool same(const JointState& a, const JointState& b) {
    return a.nut.angle == b.nut.angle && a.torque == b.torque && a.clamp == b.clamp &&
           a.mechanistic.friction_share == b.mechanistic.friction_share && a.common_turn == b.common_turn;
}

}  // namespace

TEST_CASE("Counter-hold: torques on the head of an M16 at 206 N·m agree with the reference") {
    JointDesign d = design_with(0.12, CounterHold::second_wrench);
    const TorqueLevers levers = torque_levers(d.thread.thread, 0.12, 0.12, d.bearing_diameter());
    const double clamp = 206.0 / levers.tightening_lever();
    const HeldPartTorques torques = held_part_torques(d, clamp);
    CHECK(torques.thread == doctest::Approx(109.0).epsilon(0.01));
    CHECK(torques.friction == doctest::Approx(97.0).epsilon(0.01));
    CHECK(torques.second_wrench() == doctest::Approx(12.0).epsilon(0.1));
    d.friction.held_bearing = 1e-6;  // greased
    CHECK(held_part_torques(d, clamp).second_wrench() == doctest::Approx(109.0).epsilon(0.01));
}

TEST_CASE("Counter-hold: friction alone holds the head above μ = 0.20 to 0.22, for M8 to M24") {
    for (const char* size : {"M8", "M10", "M12", "M16", "M20", "M24"}) {
        JointDesign d = design_with(0.12, CounterHold::second_wrench);
        d.thread = parse_thread(size).value();
        double low = 0.05, high = 0.5;
        while (high - low > 1e-6) {
            const double mu = 0.5 * (low + high);
            d.friction.thread = d.friction.bearing = mu;
            (held_part_torques(d, 10e3).second_wrench() > 0.0 ? low : high) = mu;
        }
        CAPTURE(size);
        CHECK(low > 0.195);
        CHECK(low < 0.225);
    }
}

TEST_CASE("Counter-hold: a held joint follows a fixed one to the bit") {
    Pull fixed(design_with(0.12, CounterHold::fixed)), free(design_with(0.12, CounterHold::second_wrench));
    for (int i = 0; i < 26'000; ++i) {
        const double speed = i % 1000 < 700 ? 30.0 : i % 1000 < 800 ? 0.0 : -20.0;
        fixed.step(speed, 0.0);
        free.step(speed, held);
        REQUIRE(same(fixed.joint(), free.joint()));
    }
    CHECK(fixed.joint().clamp > 20e3);
}

TEST_CASE("Counter-hold: the torque of nut and bolt that turn together is the friction of their faces") {
    Pull pull(design_with(0.12, CounterHold::second_wrench));
    pull.tighten_to(20e3);
    const double angle = pull.joint().nut.angle, clamp = pull.joint().clamp;
    for (int i = 0; i < 9000; ++i) pull.step(20.0, 0.0);
    CHECK(pull.joint().nut.angle == angle);
    CHECK(pull.joint().clamp == doctest::Approx(clamp).epsilon(1e-6));
    CHECK(to_degrees(pull.joint().common_turn) == doctest::Approx(180.0).epsilon(0.02));
    const MechanisticParameters& p = pull.group.joints[0];
    const double faces = clamp * (p.levers.bearing + p.held_lever);
    CHECK(pull.joint().torque == doctest::Approx(faces).epsilon(0.01));
    // The shank carries only what friction under the head holds, which is less than while tightening.
    CHECK(pull.joint().mechanistic.friction_share < 1.0);

    SUBCASE("a second wrench lets the nut tighten on") {
        pull.tighten_to(40e3);
        CHECK(pull.joint().clamp >= 40e3);
        CHECK(to_degrees(pull.joint().common_turn) == doctest::Approx(180.0).epsilon(0.02));
    }
    SUBCASE("fingers hold the head only up to their torque") {
        const double turned = pull.joint().common_turn;
        const double before = pull.joint().torque;
        for (int i = 0; i < 3000; ++i) pull.step(20.0, 0.8);
        CHECK(pull.joint().torque == doctest::Approx(before + 0.8).epsilon(1e-3));
        CHECK(pull.joint().common_turn > turned);
    }
    SUBCASE("the nut is loosened, because the thread then turns the bolt with less than friction holds") {
        for (int i = 0; i < 4000; ++i) pull.step(-20.0, 0.0);
        CHECK(pull.joint().clamp < 0.5 * clamp);
    }
}

TEST_CASE("Counter-hold: friction of 0.3 holds the head, and the nut tightens") {
    Pull pull(design_with(0.3, CounterHold::second_wrench));
    pull.tighten_to(5e3);
    const double turned = pull.joint().common_turn;
    for (int i = 0; i < 3000; ++i) pull.step(20.0, 0.0);
    CHECK(pull.joint().clamp > 20e3);
    CHECK(pull.joint().common_turn == turned);
}

TEST_CASE("Counter-hold: a free bolt turns with its nut during run-down, and with a locking nut") {
    JointDesign d = design_with(0.12, CounterHold::second_wrench);
    Pull spun(d);
    for (int i = 0; i < 5000; ++i) spun.step(60.0, 0.0);
    CHECK(to_degrees(spun.joint().nut.angle) < 10.0);
    CHECK(to_degrees(spun.joint().common_turn) > 280.0);
    d.prevailing_torque = 8.0;
    Pull locking(d);
    for (int i = 0; i < 5000; ++i) locking.step(60.0, 0.8);  // the fingers of the other hand
    CHECK(locking.joint().nut.angle == 0.0);
}

TEST_CASE("Counter-hold: random turning and holding generates no energy") {
    Random random(20, 0);
    for (int run = 0; run < 20; ++run) {
        JointDesign d = test::random_joint(random);
        d.counter_hold = CounterHold::second_wrench;
        d.friction.held_bearing = random.uniform(0.02, 0.4);
        d.embedding_time = 1e9;
        Pull pull(d);
        double work = 0.0, speed = 0.0, hold = 0.0;
        for (int i = 0; i < 20'000; ++i) {
            if (i % 250 == 0) {
                speed = random.uniform(-120.0, 160.0);
                hold = random.chance(0.4) ? held : random.chance(0.5) ? 0.0 : random.uniform(0.0, 5.0);
            }
            const double torque = pull.joint().torque;
            pull.step(speed, hold);
            work += 0.5 * (torque + pull.joint().torque) * to_radians(speed) * dt;
        }
        // The energy that the joint can return: that of its elastic parts, and of the wrench's spring.
        const JointState& joint = pull.joint();
        CHECK(work > -1e-3 - 0.5 * square(joint.torque) / pull.drive.stiffness);
        CHECK(std::isfinite(joint.common_turn));
    }
}

}  // namespace counter_hold_test
