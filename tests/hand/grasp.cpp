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
constexpr double count = to_radians(0.75);  // about one count of the glove

// A hand at a bar, whose measured angles are given frame by frame.
struct GraspBench {
    TestTool held = bar();
    hand::Hand hand = hand::make_hand(hand::Side::right);
    GraspOptions options;
    GraspState grasp;
    Random random{7};
    double noise = 0.0;  // counts, amplitude
    std::vector<GraspEvent> events;
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
        const bool before = grasp.held;
        const GraspEvent now = update_grasp(grasp, options, held.tool, hand, input, dt);
        if (now != GraspEvent::none) events.push_back(now);
        if (grasp.held != before) ++changes;
    }
    void close_to(double share, double seconds, bool fresh = true) {
        for (double t = 0.0; t < seconds; t += dt) frame(closed(share), fresh);
    }
};

}  // namespace

TEST_CASE("Grasp: a closing hand takes the tool and an opening one releases it, each reported once") {
    GraspBench bench;
    bench.close_to(0.0, 0.5);
    CHECK(!bench.grasp.held);
    bench.close_to(1.0, 0.02);  // too brief for a grasp
    CHECK(!bench.grasp.held);
    bench.close_to(0.0, 0.5);
    bench.close_to(1.0, 0.5);
    CHECK(bench.grasp.held);
    CHECK(bench.events == std::vector<GraspEvent>{GraspEvent::grasped});
    // The displayed hand is around the handle, not the measured fist.
    CHECK(bench.grasp.closure.angles.fingers[0].mcp < 0.8 * bench.grasp.measured.fingers[0].mcp);
    bench.close_to(0.0, 0.1);  // too brief for a release
    CHECK(bench.grasp.held);
    bench.close_to(1.0, 0.1);
    bench.close_to(0.0, 0.5);
    CHECK(!bench.grasp.held);
    CHECK(bench.events == std::vector<GraspEvent>{GraspEvent::grasped, GraspEvent::released});
}

TEST_CASE("Grasp: with the shipped 24 mm wrench, contacts agree with brute force") {
    const char* content = std::getenv("BOLTWRIGHT_CONTENT");
    const std::filesystem::path folder = content == nullptr ? "content" : content;
    const TestTool wrench = of(contact_test::load_parts(folder / "tools/wrench-24.contact.glb"));
    const hand::Hand hand = hand::make_hand(hand::Side::right);
    // The handle lies along x; its end is 0.28 m from the jaw.
    const Pose wrist = across_the_palm();
    const Pose at{wrist.position + Vec3(0.2, 0.0, 0.0), wrist.orientation};
    GraspState grasp;
    for (int i = 0; i < 8; ++i) update_grasp(grasp, {}, wrench.tool, hand, {true, closed(1.0), at}, dt);
    CHECK(grasp.held);
    for (std::size_t d = 0; d < hand::digit_count; ++d) {
        CHECK(grasp.closure.digits[d].touches);
        CHECK(deepest(wrench, hand, at, d, grasp.closure.angles) < 0.65 * mm);
        CHECK(deepest(wrench, hand, at, d, closed(1.0)) > 0.0);  // the measured angles alone would penetrate
    }
}

TEST_CASE("Grasp: a held tool follows the hand") {
    GraspBench bench;
    bench.close_to(1.0, 0.5);
    REQUIRE(bench.grasp.held);
    GraspInput input{true, closed(1.0), {{0.0, 0.0, 5.0}, {1.0, 0.0, 0.0, 0.0}}};
    update_grasp(bench.grasp, bench.options, bench.held.tool, bench.hand, input, dt);
    CHECK(bench.grasp.held);
    CHECK(bench.grasp.wrist.position == across_the_palm().position);
}

TEST_CASE("Grasp: a step neither allocates nor locks nor calls the system") {
    GraspBench bench;
    for (const double share : {0.0, 0.9, 1.0, 1.0, 1.0, 0.0}) {
        const GraspInput input{true, closed(share), across_the_palm()};
        GraspEvent events{};
        const test::Forbidden forbidden = test::forbidden_in([&] {
            events = update_grasp(bench.grasp, bench.options, bench.held.tool, bench.hand, input, 0.02);
        });
        CHECK(forbidden.all() == 0);
        bench.events.push_back(events);
    }
    CHECK(std::count(bench.events.begin(), bench.events.end(), GraspEvent::grasped) == 1);
}

TEST_CASE("Grasp: fingers alone do not hold, nor does the thumb") {
    for (const bool thumb : {false, true}) {
        GraspBench bench;
        hand::Angles angles = closed(thumb ? 0.0 : 1.0);
        angles.thumb = closed(thumb ? 1.0 : 0.0).thumb;
        for (int i = 0; i < 80; ++i) bench.frame(angles);
        CHECK(!bench.grasp.held);
    }
}

TEST_CASE("Grasp: no chatter at any half-closed posture under noise of one count") {
    for (int half = 0; half <= (test::sanitized ? 6 : 24); ++half) {
        GraspBench bench;
        bench.noise = 1.0;
        bench.close_to(0.0, 0.2);
        bench.close_to(half / (test::sanitized ? 6.0 : 24.0), 4.0);
        CAPTURE(half);
        CHECK(bench.changes <= 1);
    }
}

TEST_CASE("Grasp: slow closing and opening grasp and release once; without hysteresis it would chatter") {
    const auto slowly = [](GraspBench& bench) {
        for (int i = 0; i <= 600; ++i) bench.frame(closed(i / 600.0));
        for (int i = 600; i >= 0; --i) bench.frame(closed(i / 600.0));
        return bench.changes;
    };
    constexpr int seeds = test::sanitized ? 1 : 4;
    int without = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        GraspBench bench;
        bench.random = Random(static_cast<std::uint64_t>(seed));
        bench.noise = 1.0;
        CHECK(slowly(bench) == 2);
        GraspBench bare;
        bare.random = Random(static_cast<std::uint64_t>(seed));
        bare.noise = 1.0;
        bare.options.release_distance = hand::touch_distance;
        bare.options.grasp_delay = bare.options.release_delay = 0.0;
        without += slowly(bare);
    }
    CHECK(without > seeds * 2);
}

TEST_CASE(
    "Grasp: a lost glove keeps the tool and is reported; after its return nothing is released at first") {
    for (const double back : {0.0, 1.0}) {
        GraspBench bench;
        bench.close_to(1.0, 0.5);
        REQUIRE(bench.grasp.held);
        bench.events.clear();
        bench.close_to(0.0, 0.09, false);
        CHECK(!bench.grasp.lost);
        bench.close_to(0.0, 20.0, false);
        CHECK(bench.grasp.held);
        CHECK(bench.grasp.lost);
        CHECK(bench.events == std::vector<GraspEvent>{GraspEvent::glove_lost});
        CHECK(std::string(message_for(GraspEvent::glove_lost, true)).find("stays") != std::string::npos);
        bench.close_to(back, 0.5);
        CHECK(bench.grasp.held);
        CHECK(!bench.grasp.lost);
        CHECK(bench.events == std::vector<GraspEvent>{GraspEvent::glove_lost, GraspEvent::glove_back});
        bench.close_to(back, 0.5);
        CHECK(bench.grasp.held == (back > 0.5));
    }
}

TEST_CASE("Grasp: a lost glove grasps nothing, and one that never sent is not lost") {
    GraspBench bench;
    bench.close_to(1.0, 2.0, false);
    CHECK(!bench.grasp.held);
    CHECK(bench.events.empty());
    bench.close_to(0.0, 0.2);
    bench.frame(closed(1.0));
    bench.close_to(1.0, 2.0, false);
    CHECK(bench.grasp.lost);
    CHECK(!bench.grasp.held);
    CHECK(bench.events == std::vector<GraspEvent>{GraspEvent::glove_lost});
}
