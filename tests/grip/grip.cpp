#include "haptics/grip/grip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/base/random.hpp"
#include "tests/grip/scene.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::grip;
using namespace grip_test;

namespace {

constexpr double dt = 1.0 / 80.0;
constexpr double count = to_radians(0.75);  // what a step of the glove's numbers is, about

// A hand at a bar; what it closes to is told frame by frame.
struct Play {
    Held held = bar();
    hand::Hand hand = hand::make_hand(hand::Side::right);
    GripOptions options;
    Grip grip;
    Random random{7};
    double noise = 0.0;  // counts, either way
    std::vector<Told> told;
    int changes = 0;

    void frame(const hand::Angles& angles, bool fresh = true) {
        GripInput input{fresh, angles, across_the_palm()};
        const auto shake = [&](double& angle) { angle += noise * count * random.uniform(-1.0, 1.0); };
        for (hand::FingerAngles& f : input.measured.fingers) {
            shake(f.mcp);
            shake(f.pip);
            shake(f.dip);
        }
        shake(input.measured.thumb.abduction);
        shake(input.measured.thumb.mcp);
        shake(input.measured.thumb.ip);
        const bool before = grip.held;
        const Told now = step(grip, options, held.tool, hand, input, dt);
        if (now != Told::nothing) told.push_back(now);
        if (grip.held != before) ++changes;
    }
    void close_to(double share, double seconds, bool fresh = true) {
        for (double t = 0.0; t < seconds; t += dt) frame(closed(share), fresh);
    }
};

}  // namespace

TEST_CASE("grip: a hand that closes takes the tool, one that opens lets it go, each told once") {
    Play play;
    play.close_to(0.0, 0.5);
    CHECK(!play.grip.held);
    play.close_to(1.0, 0.02);  // a glance is no grip
    CHECK(!play.grip.held);
    play.close_to(0.0, 0.5);
    play.close_to(1.0, 0.5);
    CHECK(play.grip.held);
    CHECK(play.told == std::vector<Told>{Told::taken});
    // Shown is a hand around the handle, not the fist that was measured.
    CHECK(play.grip.closing.shown.fingers[0].mcp < 0.8 * play.grip.measured.fingers[0].mcp);
    play.close_to(0.0, 0.1);  // for a moment only
    CHECK(play.grip.held);
    play.close_to(1.0, 0.1);
    play.close_to(0.0, 0.5);
    CHECK(!play.grip.held);
    CHECK(play.told == std::vector<Told>{Told::taken, Told::let_go});
}

TEST_CASE("grip: the wrench of 24 mm that is shipped, by brute force") {
    const char* content = std::getenv("BOLTWRIGHT_CONTENT");
    const std::filesystem::path folder = content == nullptr ? "content" : content;
    const Held wrench = of(contact_test::load_parts(folder / "tools/wrench-24.contact.glb"));
    const hand::Hand hand = hand::make_hand(hand::Side::right);
    // Its handle lies along x, the end of it 0.28 m from the jaw.
    const Pose wrist = across_the_palm();
    const Pose at{wrist.position + Vec3(0.2, 0.0, 0.0), wrist.orientation};
    Grip grip;
    for (int i = 0; i < 8; ++i) step(grip, {}, wrench.tool, hand, {true, closed(1.0), at}, dt);
    CHECK(grip.held);
    for (std::size_t d = 0; d < hand::digit_count; ++d) {
        CHECK(grip.closing.digits[d].touches);
        CHECK(deepest(wrench, hand, at, d, grip.closing.shown) < 0.65 * mm);
        CHECK(deepest(wrench, hand, at, d, closed(1.0)) > 0.0);  // which the glove alone would show
    }
}

TEST_CASE("grip: what is held goes with the hand, wherever that goes") {
    Play play;
    play.close_to(1.0, 0.5);
    REQUIRE(play.grip.held);
    GripInput input{true, closed(1.0), {{0.0, 0.0, 5.0}, {1.0, 0.0, 0.0, 0.0}}};
    step(play.grip, play.options, play.held.tool, play.hand, input, dt);
    CHECK(play.grip.held);
    CHECK(play.grip.wrist.position == across_the_palm().position);
}

TEST_CASE("grip: a step allocates nothing, locks nothing, asks nobody") {
    Play play;
    for (const double share : {0.0, 0.9, 1.0, 1.0, 1.0, 0.0}) {
        const GripInput input{true, closed(share), across_the_palm()};
        Told told{};
        const test::Forbidden forbidden = test::forbidden_in(
            [&] { told = step(play.grip, play.options, play.held.tool, play.hand, input, 0.02); });
        CHECK(forbidden.all() == 0);
        play.told.push_back(told);
    }
    CHECK(std::count(play.told.begin(), play.told.end(), Told::taken) == 1);
}

TEST_CASE("grip: fingers alone do not hold, nor the thumb alone") {
    for (const bool thumb : {false, true}) {
        Play play;
        hand::Angles angles = closed(thumb ? 0.0 : 1.0);
        angles.thumb = closed(thumb ? 1.0 : 0.0).thumb;
        for (int i = 0; i < 80; ++i) play.frame(angles);
        CHECK(!play.grip.held);
    }
}

TEST_CASE("grip: no chatter, wherever the hand stops half closed and however its numbers tremble by one") {
    for (int half = 0; half <= (test::sanitized ? 6 : 24); ++half) {
        Play play;
        play.noise = 1.0;
        play.close_to(0.0, 0.2);
        play.close_to(half / (test::sanitized ? 6.0 : 24.0), 4.0);
        CAPTURE(half);
        CHECK(play.changes <= 1);
    }
}

TEST_CASE("grip: closing and opening slowly takes and lets go once; without hysteresis it would chatter") {
    const auto slowly = [](Play& play) {
        for (int i = 0; i <= 600; ++i) play.frame(closed(i / 600.0));
        for (int i = 600; i >= 0; --i) play.frame(closed(i / 600.0));
        return play.changes;
    };
    constexpr int seeds = test::sanitized ? 1 : 4;
    int without = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        Play play;
        play.random = Random(static_cast<std::uint64_t>(seed));
        play.noise = 1.0;
        CHECK(slowly(play) == 2);
        Play bare;
        bare.random = Random(static_cast<std::uint64_t>(seed));
        bare.noise = 1.0;
        bare.options.away = contact::touching;
        bare.options.take_after = bare.options.let_go_after = 0.0;
        without += slowly(bare);
    }
    CHECK(without > seeds * 2);
}

TEST_CASE(
    "grip: the glove is lost: the tool stays, the trainee is told; it is back: first thought, then done") {
    for (const double back : {0.0, 1.0}) {
        Play play;
        play.close_to(1.0, 0.5);
        REQUIRE(play.grip.held);
        play.told.clear();
        play.close_to(0.0, 0.09, false);
        CHECK(!play.grip.lost);
        play.close_to(0.0, 20.0, false);
        CHECK(play.grip.held);
        CHECK(play.grip.lost);
        CHECK(play.told == std::vector<Told>{Told::glove_lost});
        CHECK(std::string(words(Told::glove_lost, true)).find("stays") != std::string::npos);
        play.close_to(back, 0.5);
        CHECK(play.grip.held);
        CHECK(!play.grip.lost);
        CHECK(play.told == std::vector<Told>{Told::glove_lost, Told::glove_back});
        play.close_to(back, 0.5);
        CHECK(play.grip.held == (back > 0.5));
    }
}

TEST_CASE("grip: a lost glove takes nothing, and one that never came is not lost") {
    Play play;
    play.close_to(1.0, 2.0, false);
    CHECK(!play.grip.held);
    CHECK(play.told.empty());
    play.close_to(0.0, 0.2);
    play.frame(closed(1.0));
    play.close_to(1.0, 2.0, false);
    CHECK(play.grip.lost);
    CHECK(!play.grip.held);
    CHECK(play.told == std::vector<Told>{Told::glove_lost});
}
