#include "haptics/hand/kinematics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

Angles random_angles(Random& random) {
    const auto in = [&](const AngleRange& span) { return random.uniform(span.low, span.high); };
    Angles a;
    a.thumb = {in(thumb_roll_range), in(thumb_abduction_range), in(thumb_mcp_range), in(thumb_ip_range)};
    for (FingerAngles& f : a.fingers) f = {in(mcp_range), in(pip_range), in(dip_range), in(abduction_range)};
    a.arch = in(arch_range);
    a.wrist_flexion = in(wrist_flexion_range);
    a.wrist_deviation = in(wrist_deviation_range);
    return a;
}

Angles fist() {
    Angles a;
    for (FingerAngles& f : a.fingers) f = {to_radians(88.0), to_radians(100.0), to_radians(65.0), 0.0};
    a.thumb = {to_radians(65.0), to_radians(20.0), to_radians(35.0), to_radians(50.0)};
    a.arch = to_radians(15.0);
    return a;
}

double gap(const Skeleton& s, std::size_t a, std::size_t b) {
    return glm::length(s.position[a] - s.position[b]);
}

}  // namespace

TEST_CASE("Kinematics: zero angles give a flat hand") {
    for (const Side side : {Side::right, Side::left}) {
        const Skeleton s = joints(make_hand(side), {}, {});
        const double sign = side == Side::right ? 1.0 : -1.0;
        for (std::size_t d = 1; d < digit_count; ++d) {
            const std::size_t first = digits[d].first;
            const Vec3 finger = glm::normalize(s.position[first + 4] - s.position[first + 1]);
            CHECK(finger.z < -0.999);
            for (std::size_t k = 2; k < 4; ++k) {
                const Vec3 bone = glm::normalize(s.position[first + k + 1] - s.position[first + k]);
                CHECK(glm::dot(bone, finger) > 1.0 - 1e-12);
            }
            CHECK(std::abs(finger.y) < 1e-9);
            if (d > 1) CHECK(sign * (s.position[first + 2].x - s.position[first - 3].x) > 15.0 * mm);
        }
        const Vec3 thumb = glm::normalize(s.position[thumb_tip] - s.position[thumb_metacarpal]);
        CHECK(std::abs(thumb.y) < 1e-9);
        CHECK(sign * s.position[thumb_tip].x < sign * s.position[index_proximal].x);
    }
}

TEST_CASE("Kinematics: a finger is a planar chain whose flexions add up") {
    // Closed form in the plane of the middle finger: each bone is inclined by the sum of the angles so far.
    const Hand hand = make_hand(Side::right);
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        Angles a;
        FingerAngles& f = a.fingers[1];
        f = {random.uniform(-0.7, 1.7), random.uniform(-0.1, 2.0), random.uniform(-0.1, 1.6), 0.0};
        const Skeleton s = joints(hand, a, {});
        const std::size_t knuckle = middle_proximal;
        const Vec3 forward = hand.flat.rotation[knuckle] * Vec3(0, 0, -1);
        const Vec3 down = hand.flat.rotation[knuckle] * Vec3(0, -1, 0);
        Vec3 at = hand.flat.position[knuckle];
        const std::array<double, 3> sums{f.mcp, f.mcp + f.pip, f.mcp + f.pip + f.dip};
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(glm::length(s.position[knuckle + k] - at) < 1e-12);
            at += gap(hand.flat, knuckle + k, knuckle + k + 1) *
                  (std::cos(sums[k]) * forward + std::sin(sums[k]) * down);
        }
        CHECK(glm::length(s.position[middle_tip] - at) < 1e-12);
    }
}

TEST_CASE(
    "Kinematics: for all angles bones keep their length, frames point along them, and the left hand mirrors "
    "the right") {
    Random random(11);
    for (int trial = 0; trial < 300; ++trial) {
        const double length = random.uniform(0.15, 0.22);
        const Hand right = make_hand(Side::right, length), left = make_hand(Side::left, length);
        const Angles a = random_angles(random);
        const Skeleton r = joints(right, a, {}), l = joints(left, a, {});
        const double scale = length / skeleton_length;
        for (const Digit& digit : digits)
            for (std::size_t k = 0; k + 1 < digit.count; ++k) {
                const std::size_t j = digit.first + k;
                CHECK(gap(r, j, j + 1) == doctest::Approx(scale * gap(right.flat, j, j + 1)).epsilon(1e-9));
                const Vec3 bone = glm::normalize(r.position[j + 1] - r.position[j]);
                CHECK(glm::dot(bone, r.rotation[j] * Vec3(0, 0, -1)) > 1.0 - 1e-9);
            }
        for (std::size_t i = 0; i < joint_count; ++i) {
            CHECK(glm::length(l.position[i] - r.position[i] * Vec3(-1, 1, 1)) < 1e-12);
            CHECK(glm::length(r.rotation[i]) == doctest::Approx(1.0).epsilon(1e-12));
            // In the mirrored frame forward and up are mirrored, and right is also reversed.
            CHECK(glm::length(l.rotation[i] * Vec3(0, 1, 0) -
                              (r.rotation[i] * Vec3(0, 1, 0)) * Vec3(-1, 1, 1)) < 1e-9);
        }
        // At another wrist pose all points move with the wrist.
        const Pose wrist_pose{{1.0, 2.0, 3.0}, rotation({0.3, -1.0, 0.5})};
        const Skeleton moved = joints(right, a, wrist_pose);
        for (std::size_t i = 0; i < joint_count; ++i)
            CHECK(glm::length(moved.position[i] - wrist_pose * r.position[i]) < 1e-12);
    }
}

TEST_CASE("Kinematics: every angle has the documented sign") {
    const Hand hand = make_hand(Side::right);
    const Skeleton flat = joints(hand, {}, {});
    const auto tip_of = [&](const Angles& a, std::size_t joint) {
        return joints(hand, a, {}).position[joint] - flat.position[joint];
    };
    const double some = 0.3;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t tip = digits[i + 1].first + 4;
        Angles a;
        a.fingers[i].mcp = some;
        CHECK(tip_of(a, tip).y < -10.0 * mm);
        a = {};
        a.fingers[i].pip = some;
        CHECK(tip_of(a, tip).y < -5.0 * mm);
        a = {};
        a.fingers[i].dip = some;
        CHECK(tip_of(a, tip).y < -2.0 * mm);
        a = {};
        a.fingers[i].abduction = some;
        CHECK((i == 0 ? -1.0 : 1.0) * tip_of(a, tip).x > 10.0 * mm);
        CHECK(std::abs(tip_of(a, tip).y) < 6.0 * mm);
    }
    Angles a;
    a.thumb.abduction = some;
    CHECK(tip_of(a, thumb_tip).x < -10.0 * mm);
    CHECK(std::abs(tip_of(a, thumb_tip).y) < 1e-9);
    a.thumb.abduction = 0.7;
    const Vec3 abducted = tip_of(a, thumb_tip);
    a.thumb.roll = some;
    CHECK(tip_of(a, thumb_tip).y < abducted.y - 10.0 * mm);
    a.thumb.roll = 1.2;
    const Vec3 rolled = tip_of(a, thumb_tip);
    a.thumb.mcp = 0.8;  // rolled across, it bends over the palm towards the little finger
    CHECK(tip_of(a, thumb_tip).x > rolled.x + 10.0 * mm);
    a = {};
    a.arch = 0.4;
    CHECK(tip_of(a, little_proximal).y < -10.0 * mm);
    CHECK(tip_of(a, ring_proximal).y < -5.0 * mm);
    CHECK(tip_of(a, ring_proximal).y > tip_of(a, little_proximal).y);
    CHECK(glm::length(tip_of(a, index_tip)) == 0.0);
    a = {};
    a.wrist_flexion = some;
    CHECK((wrist_of(hand, a, {}) * flat.position[middle_tip]).y < -20.0 * mm);
    a = {};
    a.wrist_deviation = some;
    CHECK((wrist_of(hand, a, {}) * flat.position[middle_tip]).x < -20.0 * mm);
    CHECK((wrist_of(make_hand(Side::left), a, {}) * flat.position[middle_tip]).x > 20.0 * mm);
}

TEST_CASE(
    "Kinematics: a fist puts the tips into the palm, fingers side by side without overlap, the thumb over "
    "them") {
    const Skeleton s = joints(make_hand(Side::right), clamp_to_limits(fist()), {});
    for (std::size_t d = 1; d < digit_count; ++d) {
        const std::size_t tip = digits[d].first + 4;
        CHECK(gap(s, tip, palm) < 55.0 * mm);
        CHECK(s.position[tip].y < -5.0 * mm);
        if (d > 1)
            for (std::size_t k = 1; k < 5; ++k)
                CHECK(gap(s, digits[d].first + k, digits[d - 1].first + k) > 12.0 * mm);
    }
    CHECK(s.position[thumb_tip].y < s.position[palm].y - 25.0 * mm);
}

TEST_CASE("Kinematics: the thumb can oppose every finger pad to pad") {
    // A healthy hand can do this (A. Kapandji's score of opposition, Ann. Chir. Main 5(1), 1986). Random
    // search for the angles, in a range that shrinks around the best ones.
    const Hand hand = make_hand(Side::right);
    for (std::size_t finger = 1; finger < digit_count; ++finger) {
        Random random(finger);
        Angles best;
        double least = 1.0;
        for (int i = 0; i < 6000; ++i) {
            Angles a = random_angles(random);
            if (i > 1000) {
                const double reach = 0.3 * std::exp(-i / 1500.0);
                const auto near = [&](double& angle, double to) { angle = to + reach * random.normal(); };
                near(a.thumb.roll, best.thumb.roll);
                near(a.thumb.abduction, best.thumb.abduction);
                near(a.thumb.mcp, best.thumb.mcp);
                near(a.thumb.ip, best.thumb.ip);
                FingerAngles& f = a.fingers[finger - 1];
                const FingerAngles& to = best.fingers[finger - 1];
                near(f.mcp, to.mcp);
                near(f.pip, to.pip);
                near(f.dip, to.dip);
                near(f.abduction, to.abduction);
                near(a.arch, best.arch);
            }
            a = clamp_to_limits(a);
            const Skeleton s = joints(hand, a, {});
            const Vec3 thumb = s.rotation[thumb_distal] * Vec3(0, -1, 0);
            const Vec3 other = s.rotation[digits[finger].first + 3] * Vec3(0, -1, 0);
            const double apart =
                glm::length(fingertip_pad_centre(hand, s, 0) - fingertip_pad_centre(hand, s, finger)) -
                2.0 * pad_radius;
            // The pads touch and face each other.
            const double badness = std::abs(apart) + 20.0 * mm * std::max(0.0, 0.5 + glm::dot(thumb, other));
            if (badness >= least) continue;
            least = badness;
            best = a;
        }
        CAPTURE(finger);
        CHECK(least < 1.0 * mm);
    }
}

TEST_CASE("HandLimits: feasible angles stay, others are clamped, and NaN becomes 0") {
    Random random(5);
    for (int trial = 0; trial < 500; ++trial) {
        Angles a = random_angles(random);
        const Angles once = clamp_to_limits(a);
        const Angles twice = clamp_to_limits(once);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(once.fingers[i].mcp == a.fingers[i].mcp);
            CHECK(once.fingers[i].abduction == twice.fingers[i].abduction);
            CHECK(std::abs(once.fingers[i].abduction) <= std::abs(a.fingers[i].abduction));
        }
        a.fingers[2].pip = 3.0;
        a.thumb.ip = -2.0;
        a.arch = std::numeric_limits<double>::quiet_NaN();
        const Angles bound = clamp_to_limits(a);
        CHECK(bound.fingers[2].pip == pip_range.high);
        CHECK(bound.thumb.ip == thumb_ip_range.low);
        CHECK(bound.arch == 0.0);
    }
    Angles spread;
    spread.fingers[3].abduction = 0.3;
    CHECK(clamp_to_limits(spread).fingers[3].abduction == 0.3);
    spread.fingers[3].mcp = 0.5 * pi;
    CHECK(clamp_to_limits(spread).fingers[3].abduction == 0.0);
}
