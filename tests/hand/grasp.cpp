#include "haptics/hand/grasp.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/base/random.hpp"
#include "tests/hand/test_tools.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::hand;
using namespace grasp_test;

namespace {

constexpr double dt = 1.0 / 80.0;
constexpr double count = to_radians(0.75);  // what a step of the glove's numbers is, about

// A hand at a bar; what it closes to is told frame by frame.
struct Play {
    TestTool held = bar();
    hand::Hand hand = hand::make_hand(hand::Side::right);
    GraspOptions options;
    GraspState grip;
    Random random{7};
    double noise = 0.0;  // counts, either way
    std::vector<GraspEvent> told;
    int changes = 0;

    void frame(const hand::Angles& angles, bool fresh = true) {
        GraspInput input{fresh, angles, across_the_palm()};
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
        const GraspEvent now = update_grasp(grip, options, held.tool, hand, input, dt);
        if (now != GraspEvent::none) told.push_back(now);
        if (grip.held != before) ++changes;
    }
    void close_to(double share, double seconds, bool fresh = true) {
        for (double t = 0.0; t < seconds; t += dt) frame(closed(share), fresh);
    }
};

}  // namespace

TEST_CASE("Grasp: a closing hand takes the tool and an opening one releases it, each reported once") {
    Play play;
    play.close_to(0.0, 0.5);
    CHECK(!play.grip.held);
    play.close_to(1.0, 0.02);  // a glance is no grip
    CHECK(!play.grip.held);
    play.close_to(0.0, 0.5);
    play.close_to(1.0, 0.5);
    CHECK(play.grip.held);
    CHECK(play.told == std::vector<GraspEvent>{GraspEvent::grasped});
    // Shown is a hand around the handle, not the fist that was measured.
    CHECK(play.grip.closure.angles.fingers[0].mcp < 0.8 * play.grip.measured.fingers[0].mcp);
    play.close_to(0.0, 0.1);  // for a moment only
    CHECK(play.grip.held);
    play.close_to(1.0, 0.1);
    play.close_to(0.0, 0.5);
    CHECK(!play.grip.held);
    CHECK(play.told == std::vector<GraspEvent>{GraspEvent::grasped, GraspEvent::released});
}

TEST_CASE("Grasp: with the shipped 24 mm wrench, contacts agree with brute force") {
    const char* content = std::getenv("BOLTWRIGHT_CONTENT");
    const std::filesystem::path folder = content == nullptr ? "content" : content;
    const TestTool wrench = of(contact_test::load_parts(folder / "tools/wrench-24.contact.glb"));
    const hand::Hand hand = hand::make_hand(hand::Side::right);
    // Its handle lies along x, the end of it 0.28 m from the jaw.
    const Pose wrist = across_the_palm();
    const Pose at{wrist.position + Vec3(0.2, 0.0, 0.0), wrist.orientation};
    GraspState grip;
    for (int i = 0; i < 8; ++i) update_grasp(grip, {}, wrench.tool, hand, {true, closed(1.0), at}, dt);
    CHECK(grip.held);
    for (std::size_t d = 0; d < hand::digit_count; ++d) {
        CHECK(grip.closure.digits[d].touches);
        CHECK(deepest(wrench, hand, at, d, grip.closure.angles) < 0.65 * mm);
        CHECK(deepest(wrench, hand, at, d, closed(1.0)) > 0.0);  // which the glove alone would show
    }
}

TEST_CASE("Grasp: a held tool follows the hand") {
    Play play;
    play.close_to(1.0, 0.5);
    REQUIRE(play.grip.held);
    GraspInput input{true, closed(1.0), {{0.0, 0.0, 5.0}, {1.0, 0.0, 0.0, 0.0}}};
    update_grasp(play.grip, play.options, play.held.tool, play.hand, input, dt);
    CHECK(play.grip.held);
    CHECK(play.grip.wrist.position == across_the_palm().position);
}

TEST_CASE("Grasp: a step neither allocates nor locks nor calls the system") {
    Play play;
    for (const double share : {0.0, 0.9, 1.0, 1.0, 1.0, 0.0}) {
        const GraspInput input{true, closed(share), across_the_palm()};
        GraspEvent told{};
        const test::Forbidden forbidden = test::forbidden_in(
            [&] { told = update_grasp(play.grip, play.options, play.held.tool, play.hand, input, 0.02); });
        CHECK(forbidden.all() == 0);
        play.told.push_back(told);
    }
    CHECK(std::count(play.told.begin(), play.told.end(), GraspEvent::grasped) == 1);
}

TEST_CASE("Grasp: fingers alone do not hold, nor does the thumb") {
    for (const bool thumb : {false, true}) {
        Play play;
        hand::Angles angles = closed(thumb ? 0.0 : 1.0);
        angles.thumb = closed(thumb ? 1.0 : 0.0).thumb;
        for (int i = 0; i < 80; ++i) play.frame(angles);
        CHECK(!play.grip.held);
    }
}

TEST_CASE("Grasp: no chatter at any half-closed posture under noise of one count") {
    for (int half = 0; half <= (test::sanitized ? 6 : 24); ++half) {
        Play play;
        play.noise = 1.0;
        play.close_to(0.0, 0.2);
        play.close_to(half / (test::sanitized ? 6.0 : 24.0), 4.0);
        CAPTURE(half);
        CHECK(play.changes <= 1);
    }
}

TEST_CASE("Grasp: slow closing and opening grasp and release once; without hysteresis it would chatter") {
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
        bare.options.release_distance = hand::touching;
        bare.options.grasp_delay = bare.options.release_delay = 0.0;
        without += slowly(bare);
    }
    CHECK(without > seeds * 2);
}

TEST_CASE(
    "Grasp: a lost glove keeps the tool and is reported; after its return nothing is released at first") {
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
        CHECK(play.told == std::vector<GraspEvent>{GraspEvent::glove_lost});
        CHECK(std::string(message_for(GraspEvent::glove_lost, true)).find("stays") != std::string::npos);
        play.close_to(back, 0.5);
        CHECK(play.grip.held);
        CHECK(!play.grip.lost);
        CHECK(play.told == std::vector<GraspEvent>{GraspEvent::glove_lost, GraspEvent::glove_back});
        play.close_to(back, 0.5);
        CHECK(play.grip.held == (back > 0.5));
    }
}

TEST_CASE("Grasp: a lost glove grasps nothing, and one that never sent is not lost") {
    Play play;
    play.close_to(1.0, 2.0, false);
    CHECK(!play.grip.held);
    CHECK(play.told.empty());
    play.close_to(0.0, 0.2);
    play.frame(closed(1.0));
    play.close_to(1.0, 2.0, false);
    CHECK(play.grip.lost);
    CHECK(!play.grip.held);
    CHECK(play.told == std::vector<GraspEvent>{GraspEvent::glove_lost});
}
