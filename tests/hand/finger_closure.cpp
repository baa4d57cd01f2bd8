#include "haptics/hand/finger_closure.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>

#include "engine/base/random.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tests/hand/test_tools.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::hand;
using namespace grasp_test;

namespace {

// m, the penetration that sphere_spacing and stop_tolerance permit (finger_closure.hpp).
constexpr double stated = 0.65 * mm;

bool penetrates_tool(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t d,
                     const hand::Angles& a) {
    return deepest(held, hand, wrist, d, a) > 0.0;
}

std::array<double, 3> bends(const hand::Angles& a, std::size_t digit) {
    if (digit == 0) return {-a.thumb.abduction, a.thumb.mcp, a.thumb.ip};  // closing increases all values
    const hand::FingerAngles& f = a.fingers[digit - 1];
    return {f.mcp, f.pip, f.dip};
}

hand::Angles between(const hand::Angles& a, const hand::Angles& b, double t) {
    hand::Angles out = b;
    const auto mix = [t](double from, double to) { return from + t * (to - from); };
    for (std::size_t i = 0; i < 4; ++i) {
        out.fingers[i].mcp = mix(a.fingers[i].mcp, b.fingers[i].mcp);
        out.fingers[i].pip = mix(a.fingers[i].pip, b.fingers[i].pip);
        out.fingers[i].dip = mix(a.fingers[i].dip, b.fingers[i].dip);
    }
    out.thumb.abduction = mix(a.thumb.abduction, b.thumb.abduction);
    out.thumb.mcp = mix(a.thumb.mcp, b.thumb.mcp);
    out.thumb.ip = mix(a.thumb.ip, b.thumb.ip);
    return out;
}

hand::Angles random_bend(Random& random) {
    hand::Angles a;
    const auto in = [&](double low, double high) { return to_radians(random.uniform(low, high)); };
    for (hand::FingerAngles& f : a.fingers)
        f = {in(-10.0, 95.0), in(0.0, 110.0), in(0.0, 80.0), in(-5.0, 15.0)};
    a.thumb = {in(0.0, 95.0), in(0.0, 60.0), in(0.0, 55.0), in(-10.0, 75.0)};
    a.arch = in(0.0, 20.0);
    return hand::clamp_to_limits(a);
}

// A random wrist pose from which the fingers reach the tool.
Pose random_wrist(Random& random) {
    const Pose tool{
        Vec3(random.uniform(-30.0, 30.0), random.uniform(-60.0, -20.0), random.uniform(-150.0, -60.0)) * mm,
        random_turn(random)};
    return inverse(tool);
}

template <class Check>
void at_random(int trials, Check&& check) {
    Random random(21);
    const std::array<TestTool, 3> tools{
        bar(), of({contact_test::ball(22.0 * mm, 10).mesh()}),
        of({contact_test::box(Vec3(-60.0, -40.0, -0.1) * mm, Vec3(60.0, 40.0, 0.1) * mm)
                .mesh()})};  // a sheet of 0.2 mm
    for (int trial = 0; trial < trials; ++trial) {
        const TestTool& tool = tools[static_cast<std::size_t>(trial) % tools.size()];
        const hand::Hand hand = hand::make_hand(random.chance(0.5) ? hand::Side::left : hand::Side::right,
                                                random.uniform(0.16, 0.21));
        const Pose wrist = random_wrist(random);
        check(tool, hand, wrist, random_bend(random));
    }
}

}  // namespace

TEST_CASE(
    "FingerClosure: penetration of a handle, a ball and a thin sheet stays below the stated tolerance") {
    int touching = 0, deep = 0, overlapping = 0;
    at_random(test::sanitized ? 30 : 200, [&](const TestTool& held, const hand::Hand& hand, const Pose& wrist,
                                              const hand::Angles& measured) {
        const FingerClosure closure = close_fingers(held.tool, hand, measured, wrist);
        for (std::size_t d = 0; d < hand::digit_count; ++d) {
            CAPTURE(d);
            const hand::Angles open = opened(measured);
            const bool already = penetrates_tool(held, hand, wrist, d, open);
            if (already) ++overlapping;
            // If the digit penetrates from the start, points between its balls get slightly deeper.
            CHECK(deeper(held, hand, wrist, d, closure.angles, open) < (already ? 2.0 * mm : stated));
            if (closure.digits[d].touches) ++touching;
            if (deeper(held, hand, wrist, d, measured, opened(measured)) > 3.0 * mm) ++deep;
        }
    });
    // Verifies that the measured angles alone would penetrate the tool.
    CHECK(overlapping < touching);
    CHECK(touching > (test::sanitized ? 20 : 200));
    CHECK(deep > (test::sanitized ? 15 : 150));
}

TEST_CASE("FingerClosure: a finger stops at first contact") {
    int stops = 0;
    at_random(test::sanitized ? 15 : 80, [&](const TestTool& held, const hand::Hand& hand, const Pose& wrist,
                                             const hand::Angles& measured) {
        const hand::Angles open = opened(measured);
        const FingerClosure closure = close_fingers(held.tool, hand, measured, wrist);
        for (std::size_t d = 0; d < hand::digit_count; ++d) {
            const double share = closure.digits[d].share[0];
            if (penetrates_tool(held, hand, wrist, d, open)) continue;
            for (int i = 0; i <= 20; ++i)
                CHECK(deeper(held, hand, wrist, d, between(open, measured, share * i / 20.0), open) < stated);
            if (!closure.digits[d].touches || share > 0.97) continue;
            ++stops;
            CHECK(deeper(held, hand, wrist, d, between(open, measured, share + 0.03), open) > 0.0);
        }
    });
    CHECK(stops > (test::sanitized ? 5 : 40));
}

TEST_CASE("FingerClosure: a harder squeeze gives the same stop and never a more open finger") {
    int held_back = 0, grazing = 0;
    at_random(test::sanitized ? 30 : 250, [&](const TestTool& held, const hand::Hand& hand, const Pose& wrist,
                                              const hand::Angles& measured) {
        const hand::Angles harder = between(opened(measured), measured, 1.15);
        const FingerClosure once = close_fingers(held.tool, hand, measured, wrist);
        const FingerClosure more = close_fingers(held.tool, hand, harder, wrist);
        for (std::size_t d = 0; d < hand::digit_count; ++d) {
            const auto a = bends(once.angles, d), b = bends(more.angles, d), wanted = bends(measured, d);
            if (opened(harder).thumb.abduction != opened(measured).thumb.abduction) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(a[k] < wanted[k] + 1e-12);
                if (a[k] > wanted[k] - 1e-6) {
                    if (b[k] < a[k] - 2e-3) ++grazing;
                    continue;
                }
                ++held_back;
                if (std::abs(b[k] - a[k]) > 2e-3) ++grazing;
            }
        }
    });
    CHECK(held_back > (test::sanitized ? 20 : 200));
    // A part that passes an edge within 0.1 mm may stop there or continue.
    CHECK(grazing <= held_back / 50);
}

TEST_CASE("FingerClosure: a bar inside the back of the hand does not stop the fingers from bending away") {
    const TestTool held = bar();
    const hand::Hand hand = hand::make_hand(hand::Side::right);
    const Pose wrist = inverse({Vec3(0.0, 14.5, -96.0) * mm, rotation({0.0, to_radians(-17.5), 0.0})});
    const hand::Angles measured = closed(1.0);
    const FingerClosure closure = close_fingers(held.tool, hand, measured, wrist);
    int in = 0;
    for (std::size_t d = 1; d < hand::digit_count; ++d) {
        if (penetrates_tool(held, hand, wrist, d, opened(measured))) ++in;
        CHECK(closure.angles.fingers[d - 1].mcp == doctest::Approx(measured.fingers[d - 1].mcp));
    }
    CHECK(in >= 2);
}

TEST_CASE(
    "FingerClosure: out of reach nothing changes; results are bit-identical and nothing forbidden is "
    "called") {
    const TestTool held = bar();
    const hand::Hand hand = hand::make_hand(hand::Side::right);
    const hand::Angles measured = closed(1.0);
    const FingerClosure far =
        close_fingers(held.tool, hand, measured, {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0, 0.0}});
    CHECK(std::memcmp(&far.angles, &measured, sizeof measured) == 0);
    CHECK(far.digits[1].nearest.distance == collision::infinite_distance);

    const FingerClosure first = close_fingers(held.tool, hand, measured, across_the_palm());
    FingerClosure again;
    const test::Forbidden forbidden =
        test::forbidden_in([&] { again = close_fingers(held.tool, hand, measured, across_the_palm()); });
    CHECK(forbidden.all() == 0);
    CHECK(std::memcmp(&first.angles, &again.angles, sizeof first.angles) == 0);
}

TEST_CASE("FingerClosure: fingers wrap around a bar, and the joints beyond the contact bend further") {
    const TestTool held = bar();
    for (const hand::Side side : {hand::Side::right, hand::Side::left}) {
        const hand::Hand hand = hand::make_hand(side);
        Pose wrist = across_the_palm();
        if (side == hand::Side::left) wrist = mirrored(wrist);  // in the bar's plane of symmetry
        const FingerClosure closure = close_fingers(held.tool, hand, closed(1.0), wrist);
        for (std::size_t d = 1; d < hand::digit_count; ++d) {
            const DigitStop& stop = closure.digits[d];
            CHECK(stop.touches);
            CHECK(stop.share[0] < 0.8);
            CHECK(stop.share[0] <= stop.share[1]);
            CHECK(stop.share[1] <= stop.share[2]);
            CHECK(stop.nearest.normal.y < 0.2);  // from below or from the side opposite to the palm
        }
        CHECK(closure.digits[0].touches);
    }
}
