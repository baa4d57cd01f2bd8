// The ratchet between a handle and the head of a tool.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"
#include "haptics/servo/engagement.hpp"
#include "tests/servo/support.hpp"

namespace bolt::servo::ratchets {

namespace {

constexpr double play = 0.015, stiffness = 2000.0, tooth = to_radians(5.0), drag = 0.25;

struct Handle {
    Wrench wrench;
    Engagement engagement;
    double nut = 0.0;    // rad; stands unless a test turns it
    double angle = 0.0;  // rad, of the handle

    explicit Handle(bool loosens = false) {
        wrench.stiffness = stiffness;
        wrench.ratchet.tooth_angle = tooth;
        wrench.ratchet.drag = drag;
        wrench.ratchet.loosens = loosens;
    }
    // N·m on the nut.
    [[nodiscard]] double torque() const {
        const double gap = engagement.hand_angle - nut;
        return stiffness * (gap - std::clamp(gap, -play, play));
    }
    double turn(double by) {
        turn_tool(wrench, by, engagement);
        settle_ratchet(wrench, nut, play, engagement);
        angle += by;
        return torque();
    }
    double turn_to(double to, double step = 1e-4) {
        while (std::abs(to - angle) > step) turn(std::copysign(step, to - angle));
        return turn(to - angle);
    }
};

}  // namespace

TEST_CASE("Ratchet: the head turns with the handle in one direction only") {
    for (const bool loosens : {false, true}) {
        Handle h(loosens);
        const double sense = loosens ? -1.0 : 1.0;
        CHECK(h.turn_to(sense * 0.05) == doctest::Approx(sense * stiffness * (0.05 - play)).epsilon(1e-6));
        CHECK(h.engagement.ratchet_slack == 0.0);
        // Back by 40°: no more than the pawl's drag, whatever the angle.
        h.turn_to(0.0);
        double most = 0.0;
        for (int i = 1; i <= 400; ++i)
            most = std::max(most, std::abs(h.turn_to(-sense * to_radians(0.1 * i))));
        CHECK(most <= drag * 1.001);
        CHECK(most > 0.9 * drag);
        // Forward again: it takes hold within one tooth and the play.
        const double from = h.angle;
        while (sense * h.torque() <= 1.0) h.turn(sense * 1e-4);
        CHECK(sense * (h.angle - from) < tooth + 2.0 * play + 1.0 / stiffness + 2e-4);
    }
}

TEST_CASE("Ratchet: the drag rises over each tooth and drops, once a tooth") {
    Handle h;
    h.turn_to(-play);
    int drops = 0;
    double before = h.torque();
    const double swing = 12.0 * tooth;
    for (int i = 0; i < 60000; ++i) {
        const double now = h.turn(-swing / 60000);
        CHECK(now <= 1e-9);
        if (now > before + 0.5 * drag)
            ++drops;
        else
            CHECK(now <= before + 1e-9);  // it only rises in magnitude between two drops
        before = now;
    }
    CHECK(drops >= 11);
    CHECK(drops <= 12);
}

TEST_CASE("Ratchet: a free nut turns back with the handle, a seated one stands") {
    Setup setup = test::two_joints();
    setup.wrench.ratchet.tooth_angle = tooth;
    setup.wrench.ratchet.drag = 2.0;  // N·m, more than the free nut's running torque
    setup.wrench.head_angle = 0.0;
    for (const bool seated : {false, true}) {
        CAPTURE(seated);
        State state = initial_state(setup);
        const NutGeometry& nut = setup.nuts[0];
        const double seat = nut.start_gap / nut.lead;
        joint::turn_nut(setup.group, state.joints, 0, seated ? seat + 0.3 : 0.5 * seat, 1.0, 0.001);
        double handle = state.joints[0].nut.angle;
        const Vec3 centre = nut_centre(nut, handle);
        const auto step = [&] {
            tick(setup, state, test::holding(Grip::wrench, test::tool_at(nut, centre, handle)));
        };
        for (int i = 0; i < 100; ++i) step();
        REQUIRE(state.engagement.joint == 0);
        const double start = state.joints[0].nut.angle;
        for (int i = 0; i < 1000; ++i) {
            handle -= 0.5e-3;
            step();
        }
        const double turned = state.joints[0].nut.angle - start;
        if (seated)
            CHECK(std::abs(turned) < 1e-3);
        else
            CHECK(turned == doctest::Approx(-0.5).epsilon(0.1));
    }
}

TEST_CASE("Ratchet: it never gives the hand energy") {
    Random random(5);
    for (int trial = 0; trial < 50; ++trial) {
        Handle h(random.uniform(0.0, 1.0) < 0.5);
        double work = 0.0, stored = 0.0;  // J, by the hand
        double speed = 0.0;
        for (int i = 0; i < 4000; ++i) {
            speed = 0.98 * speed + 2e-5 * random.normal();
            const double before = h.torque();
            const double after = h.turn(speed);
            work += 0.5 * (before + after) * speed;
            stored = 0.5 * after * after / stiffness;
            // The pawl's spring, which is wound while it climbs.
            CHECK(work > stored - drag * tooth - 1e-6);
        }
    }
}

}  // namespace bolt::servo::ratchets
