// Timing of hints: their levels, delays and durations.
#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "tests/hints/bench.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::at_work;
using test::Bench;

namespace {

using servo::Grip;

// The wrench is in the hand, far from the nut.
struct Searching : Bench {
    explicit Searching(Mode mode = Mode::guided) : Bench(mode) {
        seat_both();
        wrench = true;
    }
};

}  // namespace

TEST_CASE("Hints: guided: the level rises with the time without progress") {
    Searching b;
    int level = 0;
    double time = 0.0;
    std::vector<double> reached;
    while (time < 20.0) {
        const Hint hint = *b.frame(0.05);
        time += 0.05;
        CHECK(hint.level >= level);
        if (hint.level > level) reached.push_back(time);
        level = hint.level;
        CHECK(hint.outlined() == (level >= 1 ? 0 : -1));
        CHECK((hint.arrow() != HintMotion::none) == (level >= 1));
        CHECK((hint.ghost() != GhostKind::none) == (level >= 2));
    }
    CHECK(level == 3);
    REQUIRE(reached.size() == 3);
    CHECK(reached[0] == doctest::Approx(guided_times.level[1]).epsilon(0.05));
    CHECK(reached[1] == doctest::Approx(guided_times.level[2]).epsilon(0.05));
    CHECK(reached[2] == doctest::Approx(guided_times.level[3]).epsilon(0.05));
}

TEST_CASE("Hints: practice: each request raises the level, and the hint ends with its situation") {
    Searching b(Mode::practice);
    b.wait(4.0);
    for (const int level : {0, 1, 2, 3, 3}) {
        REQUIRE(b.frame(0.05, true));
        CHECK(b.hints.shown->level == level);
        b.wait(0.5);
        CHECK(b.hints.shown->level == level);
    }
    b.near(0);
    CHECK_FALSE(b.wait(2.0));
}

TEST_CASE("Hints: no escalation while the trainee makes progress") {
    Searching b;
    for (int i = 0; i < 600; ++i) {  // 30 s on a long detour
        b.output.constrained_tool.position = Vec3(0.0, 20.0 - 0.03 * i, 0.0);
        CHECK(b.frame()->level == 0);
    }
    Bench turning;
    turning.idle();
    for (int i = 0; i < 600; ++i) {
        turning.tick(0, Grip::fingers, 0.1, 30.0);
        CHECK(turning.frame()->level == 0);
    }
    CHECK(turning.hints.shown->situation == Situation::run_down);
}

TEST_CASE("Hints: repeatedly gripping and losing the nut is no progress") {
    Searching b;
    b.near(0);
    b.wait(3.0);
    for (int i = 0; i < 20; ++i) {
        b.tick(0, Grip::wrench, 0.2);
        b.wait(0.5);
        b.idle();
        b.wait(0.5);
    }
    CHECK(b.hints.shown->level == 3);
}

TEST_CASE("Hints: returning for the next stroke is progress") {
    Searching b;
    b.near(0);
    b.wait(3.0);
    for (int stroke = 0; stroke < 8; ++stroke) {
        b.tick(0, Grip::wrench, 2.0);
        b.wait(1.0);
        for (int i = 0; i < 200; ++i) b.tick(0, Grip::wrench, 2.0 + stroke, 1.0);
        b.frame();
        b.idle();
        for (int i = 0; i < 50; ++i) {
            b.frame();
            CHECK(b.hints.shown->level == 0);
        }
    }
}

TEST_CASE("Hints: setting the wrench on for the next stroke restarts the time without progress") {
    Searching b;
    b.near(0);
    b.wait(3.5);
    for (int i = 0; i < 200; ++i) b.tick(0, Grip::wrench, 5.0, 1.0);
    b.wait(0.5);
    b.idle();
    b.wait(3.0);
    b.tick(0, Grip::wrench, 0.2);
    CHECK(b.wait(3.0)->level == 0);
    CHECK(b.wait(1.5)->level == 1);
}

TEST_CASE("Hints: the hint stays between two finger twists; a hand that stays away gets a new one") {
    Bench b;
    b.idle();
    b.near(0);
    b.wait(4.0);
    for (int twist = 0; twist < 10; ++twist) {
        for (int i = 0; i < 400; ++i) b.tick(0, Grip::fingers, 0.1, 6.0);
        CHECK(b.wait(0.6)->situation == Situation::run_down);
        b.idle();
        CHECK(b.wait(0.8)->situation == Situation::run_down);
    }
    CHECK(b.wait(1.0)->situation == Situation::grip_nut);
}

TEST_CASE("Hints: in steps by angle the hint stays between two strokes") {
    Bench on;
    on.by_angle();
    on.near(0);
    on.wait(4.0);
    for (int stroke = 0; stroke < 3; ++stroke) {
        on.turn_by(0, 10.0);
        CHECK(on.wait(0.6)->situation == Situation::turn_on);
        on.idle();
        CHECK(on.wait(0.8)->situation == Situation::turn_on);
    }
    CHECK(on.wait(1.0)->situation == Situation::set_on_again);

    Bench back(Mode::guided, content::Strategy::torque, Task::loosen);
    back.turned_back();
    back.wrench = true;
    back.near(1);
    back.wait(4.0);
    for (int stroke = 0; stroke < 3; ++stroke) {
        back.turn_by(1, -10.0, -50.0);
        CHECK(back.wait(0.6)->situation == Situation::turn_back);
        back.idle();
        CHECK(back.wait(0.8)->situation == Situation::turn_back);
    }
    CHECK(back.wait(1.0)->situation == Situation::set_on_again);
}

TEST_CASE("Hints: near the step's angle the request to pull gently soon replaces the one to turn on") {
    Bench b;
    b.by_angle();
    b.near(0);
    b.wait(4.0);
    b.turn_by(0, 30.0);
    REQUIRE(b.wait(0.3)->situation == Situation::turn_on);
    b.tick(0, Grip::wrench, 50.0, to_radians(15.0) / 1e-3);
    CHECK(b.wait(min_duration_when_fulfilled + 0.1)->situation == Situation::ease_to_angle);
}

TEST_CASE("Hints: with rapidly changing situations the hint is updated after some seconds") {
    Searching b;
    b.wait(4.0);
    REQUIRE(b.hints.shown->situation == Situation::find_by_wrench);
    bool followed = false;
    for (int i = 0; i < 80; ++i) {
        if (i % 2 == 0)
            b.tick(0, Grip::fingers, 0.2);
        else
            b.tick(0, Grip::wrench, 0.2);
        b.frame();
        followed = followed || b.hints.shown->situation != Situation::find_by_wrench;
        if (i < 55) CHECK_FALSE(followed);
    }
    CHECK(followed);
}

TEST_CASE("Hints: stop is shown at once, a wrong action almost at once") {
    Searching b;
    b.wait(0.5);
    b.turn(0, 20.0);
    b.wait(0.5);
    CHECK(b.hints.shown->situation == Situation::pull);
    b.turn(0, 33.0);
    CHECK(b.frame(0.016)->situation == Situation::stop);

    Searching wrong;
    wrong.wait(0.2);
    wrong.tick(1, Grip::wrench, 0.2);
    CHECK(wrong.frame(0.016)->situation != Situation::wrong_joint);  // only a short touch
    CHECK(wrong.wait(0.25)->situation == Situation::wrong_joint);
    // The hint stays long enough to be read, and names the held joint.
    wrong.idle();
    wrong.wait(1.0);
    REQUIRE(wrong.hints.shown->situation == Situation::wrong_joint);
    bool named = false;
    for (const words::TextArgument& place : wrong.hints.shown->arguments)
        named = named || place.name == "held";
    CHECK(named);
    CHECK(wrong.wait(0.5)->situation != Situation::wrong_joint);
}

TEST_CASE("Hints: a pass is announced, then each next joint, for three seconds or until the hand is there") {
    Bench b;
    b.idle();
    CHECK(b.frame()->situation == Situation::pass_run_down);
    CHECK(b.wait(2.8)->situation == Situation::pass_run_down);
    CHECK(b.wait(0.4)->situation == Situation::find_by_fingers);
    b.seat(0);
    CHECK(b.frame()->situation == Situation::next);
    CHECK(b.hints.shown->joint == 1);
    b.near(1);
    CHECK(b.wait(1.0)->situation == Situation::next);
    CHECK(b.wait(0.6)->situation == Situation::grip_nut);
    b.far_away();
    b.seat(1);
    CHECK(b.frame()->situation == Situation::pass_tighten);
    b.wrench = true;
    b.pull(0, 35.0);
    b.pull(1, 35.0);
    b.pull(0, 70.0);
    b.pull(1, 70.0);
    CHECK(b.frame()->situation == Situation::pass_recheck);
    Bench loose(Mode::guided, content::Strategy::torque, Task::loosen);
    loose.idle();
    CHECK(loose.frame()->situation == Situation::pass_loosen);
}

TEST_CASE("Hints: restarting a step announces it and resets the level") {
    Searching b;
    b.wait(12.0);
    CHECK(b.hints.shown->level == 2);
    b.pull(0, 35.0);
    b.frame();
    CHECK(b.hints.shown->level == 0);
    REQUIRE(b.undo(1));
    CHECK(b.frame()->situation == Situation::next);
    CHECK(b.hints.shown->joint == 0);
}

TEST_CASE("Hints: no flicker during random actions") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        Random random(seed, 1);
        Bench b(seed % 4 == 0 ? Mode::practice : Mode::guided);
        b.idle();
        if (seed % 2 == 0) b.seat_both();
        std::optional<Hint> previous;
        double shown_for = 1e9;
        std::size_t step = b.lesson.current;
        int changes = 0;
        int joint = -1;
        Grip grip = Grip::fingers;
        double torque = 0.0, speed = 0.0;
        for (int i = 0; i < 6000; ++i) {
            // Random changes, in alternation at short intervals and seconds apart.
            if (random.chance(i / 1000 % 2 == 0 ? 0.02 : 0.3)) {
                const std::uint64_t die = random.bits() % 8;
                if (die == 0) b.wrench = !b.wrench;
                if (die == 1) b.near(random.bits() % 2);
                if (die == 2) b.far_away();
                if (die == 3) b.free_swing = random.chance(0.5) ? 0.0 : 1.0;
                joint = static_cast<int>(random.bits() % 3) - 1;
                grip = random.chance(0.5) ? Grip::fingers : Grip::wrench;
                torque = random.uniform(-3.0, 30.0);
                speed = random.uniform(-1.0, 1.0);
            }
            b.tick(joint, grip, torque, speed);
            const bool requested = random.chance(0.01);
            const std::optional<Hint>& shown = b.frame(0.016, requested);
            shown_for += 0.016;
            const bool same = shown.has_value() == previous.has_value() &&
                              (!shown || shown->situation == previous->situation);
            if (!same) {
                ++changes;
                const bool other_step = b.lesson.current != step;
                const bool wanted = !previous || !shown;  // in practice, requests show and end hints
                const Situation now = shown ? shown->situation : Situation::all_done;
                const bool urgent = now == Situation::stop || now == Situation::stop_too_much ||
                                    now == Situation::wrong_joint || now == Situation::other_way_on ||
                                    now == Situation::checked || now == Situation::seated;
                if (!other_step && !wanted && !urgent)
                    CHECK(shown_for >=
                          (at_work(now) ? min_duration_when_fulfilled : min_hint_duration) - 1e-9);
                shown_for = 0.0;
            }
            step = b.lesson.current;
            previous = shown;
        }
        CHECK(changes > 10);
    }
}
