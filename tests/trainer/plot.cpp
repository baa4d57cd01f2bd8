// The torque plot of a pull.
#include "game/trainer/hud.hpp"

#include <doctest/doctest.h>

#include "tests/lesson/script.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using test::Script;

namespace {

// One tick of a pull, added to the plot.
void pull(Script& s, trainer::TorquePlot& plot, int joint, double torque) {
    s.tick(joint, servo::Grip::wrench, torque, 1.0);
    trainer::observe(plot, s.lesson, test::HapticWorld(2).write(s.output));
}

}  // namespace

TEST_CASE("Torque plot: the target is the window of the due pass, not the joint's final one") {
    Script s;
    s.seat_both();
    trainer::TorquePlot plot;
    pull(s, plot, 0, 5.0);
    REQUIRE(plot.target);
    CHECK(plot.target->low == doctest::Approx(31.5));
    CHECK(plot.target->high == doctest::Approx(38.5));
    pull(s, plot, 1, 5.0);  // out of turn: the final window
    REQUIRE(plot.target);
    CHECK(plot.target->low == doctest::Approx(63.0));
    s.idle();
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    pull(s, plot, 0, 5.0);
    CHECK(plot.target->low == doctest::Approx(63.0));
    trainer::observe(plot, s.lesson,
                     test::HapticWorld(2).write({}));  // a hand in the air does not change the plot
    CHECK(plot.joint == 0);
    CHECK(plot.target);
}

TEST_CASE("Torque plot: it restarts at another nut and keeps only points that differ visibly") {
    Script s;
    s.seat_both();
    trainer::TorquePlot plot;
    for (int i = 0; i < 100; ++i) pull(s, plot, 0, 0.1 * i);
    CHECK(plot.points.size() > 40);
    CHECK(plot.points.size() <= 100);
    pull(s, plot, 1, 1.0);
    CHECK(plot.points.size() == 1);
}

TEST_CASE("Torque plot: however long the pull, it ends at the present torque") {
    Script s;
    s.seat_both();
    trainer::TorquePlot plot;
    for (int i = 0; i < 20000; ++i) {
        s.tick(0, servo::Grip::wrench, 0.001 * i, 1.0 + 0.01 * i);
        trainer::observe(plot, s.lesson, test::HapticWorld(2).write(s.output));
    }
    CHECK(plot.points.size() <= 4000);
    CHECK(plot.points.size() > 1000);
    CHECK(plot.points.front().torque < 1.0F);
    CHECK(plot.points.back().torque == doctest::Approx(20.0).epsilon(0.1));
    for (std::size_t i = 1; i < plot.points.size(); ++i)
        REQUIRE(plot.points[i].angle > plot.points[i - 1].angle);
    pull(s, plot, 1, 1.0);
    CHECK(plot.coarseness == 1.0F);
}

TEST_CASE("Torque plot: loosening has no target") {
    Script s;
    s.lesson = lesson::begin(s.assembly, lesson::Mode::guided, lesson::Task::loosen);
    trainer::TorquePlot plot;
    pull(s, plot, 0, -5.0);
    CHECK(plot.points.size() == 1);
    CHECK(!plot.target);
}
