// What the plot of a pull shows.

#include "game/trainer/hud.hpp"

#include <doctest/doctest.h>

#include "tests/lesson/script.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using test::Script;

namespace {

// A tick of a hand that pulls, and its plot.
void pull(Script& s, trainer::Plot& plot, int joint, double torque) {
    s.tick(joint, servo::Grip::wrench, torque, 1.0);
    trainer::note(plot, s.lesson, test::HapticWorld(2).write(s.output));
}

}  // namespace

TEST_CASE("a pull's plot aims at the window of its pass, not at the joint's last") {
    Script s;
    s.seat_both();
    trainer::Plot plot;
    pull(s, plot, 0, 5.0);
    REQUIRE(plot.aim);
    CHECK(plot.aim->low == doctest::Approx(31.5));
    CHECK(plot.aim->high == doctest::Approx(38.5));
    pull(s, plot, 1, 5.0);  // out of turn: what it is to have at the end
    REQUIRE(plot.aim);
    CHECK(plot.aim->low == doctest::Approx(63.0));
    s.idle();
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    pull(s, plot, 0, 5.0);
    CHECK(plot.aim->low == doctest::Approx(63.0));
    trainer::note(plot, s.lesson, test::HapticWorld(2).write({}));  // a hand in the air leaves it as it is
    CHECK(plot.joint == 0);
    CHECK(plot.aim);
}

TEST_CASE("a pull's plot begins anew at another nut, and keeps what differs by a pixel") {
    Script s;
    s.seat_both();
    trainer::Plot plot;
    for (int i = 0; i < 100; ++i) pull(s, plot, 0, 0.1 * i);
    CHECK(plot.points.size() > 40);
    CHECK(plot.points.size() <= 100);
    pull(s, plot, 1, 1.0);
    CHECK(plot.points.size() == 1);
}

TEST_CASE("a nut that comes off has no torque to aim at") {
    Script s;
    s.lesson = lesson::begin(s.assembly, lesson::Mode::guided, lesson::Task::loosen);
    trainer::Plot plot;
    pull(s, plot, 0, -5.0);
    CHECK(plot.points.size() == 1);
    CHECK(!plot.aim);
}
