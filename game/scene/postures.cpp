#include "game/scene/postures.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::scene {

namespace {

constexpr double follows = 0.09, trembles = 0.012;  // s, time constants
constexpr double lively = 6.0;                      // tremor of so much of a change
constexpr double rest = 1e-3;                       // below it nothing is strained any more

void follow(double& value, double to, double dt, double time) {
    value += (to - value) * (1.0 - std::exp(-dt / time));
}

}  // namespace

double effort(const servo::Setup& setup, const EffortAccess& world) {
    const std::int16_t engaged = world.only<world::ToolContact>().joint;
    if (engaged < 0) return 0.0;
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(engaged));
    const double most = world.only<world::Hand>().wrench ? setup.wrench.stiffness * to_radians(2.5)
                                                         : setup.finger_torque(setup.nuts[joint.index]);
    return std::clamp(joint.torque / most, -1.0, 1.0);
}

void strain(Strain& s, const servo::Setup& setup, const EffortAccess& world) {
    const double now = effort(setup, world);
    follow(s.quick, now, setup.dt, trembles);
    follow(s.slow, now, setup.dt, follows);
    follow(s.share, std::abs(now), setup.dt, follows);
    s.tremor = std::clamp(lively * (s.quick - s.slow), -1.0, 1.0) * std::min(1.0, 3.0 * s.share);
    if (now == 0.0 && s.share < rest && std::abs(s.slow) < rest && std::abs(s.quick) < rest) s = {};
}

namespace {

constexpr double deg = pi / 180.0;
constexpr double glove = 2.5e-3;  // m, of the drawn hand beyond the pads
constexpr double pad_lift =
    3e-3;  // m, of the pads above the middle of a nut: their lower edge clears its seat
constexpr double strained_wrist = 11.0 * deg;

// Fingers bent by a share of a fist's, the thumb opposed. Chosen by eye.
hand::Angles closed(double share) {
    hand::Angles a;
    for (hand::FingerAngles& f : a.fingers)
        f = {share * 70.0 * deg, share * 95.0 * deg, share * 60.0 * deg, 0.0};
    a.thumb = {70.0 * deg, (60.0 - 48.0 * share) * deg, share * 50.0 * deg, share * 65.0 * deg};
    a.arch = 8.0 * deg;
    return a;
}

// Thumb against index and middle finger, with the other two stretched over what lies beside the nut.
hand::Angles pinched(double thumb_abduction) {
    hand::Angles a = closed(0.25);
    a.fingers[0] = {62.0 * deg, 32.0 * deg, 14.0 * deg, 0.0};
    a.fingers[1] = {64.0 * deg, 34.0 * deg, 16.0 * deg, 0.0};
    a.thumb = {80.0 * deg, thumb_abduction, 4.0 * deg, 8.0 * deg};
    return a;
}

// The vector from the pad of the thumb to that of the index finger, in the frame of the wrist.
Vec3 between_pads(const hand::Hand& hand, const hand::Angles& angles) {
    const hand::Skeleton joints = hand::joints(hand, angles, Pose{});
    return hand::pad(hand, joints, 1) - hand::pad(hand, joints, 0);
}

// The pinch whose pads just touch the corners of a nut that is `width` (m) across flats: the nut turns
// between them.
hand::Angles pinched_on(const hand::Hand& hand, double width) {
    const double wanted = 2.0 / std::sqrt(3.0) * width + 2.0 * (hand::pad_radius + glove);
    double narrow = 5.0 * deg, wide = 65.0 * deg;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (narrow + wide);
        (glm::length(between_pads(hand, pinched(middle))) < wanted ? narrow : wide) = middle;
    }
    return pinched(0.5 * (narrow + wide));
}

// Of a right wrist: the line between the pads lies across the nut's axis and towards −x, the back of the hand
// is up (+z).
Quat over_nut(const Vec3& between_pads) {
    const Vec3 line = glm::normalize(between_pads);
    const Vec3 back = glm::normalize(Vec3(0, 1, 0) - line.y * line);
    const glm::dmat3 own(line, back, glm::cross(line, back));
    const glm::dmat3 wanted(Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0));
    return glm::normalize(glm::quat_cast(wanted * glm::transpose(own)));
}

// A left hand is a right one in a mirror across the tool, in its plane y = 0, and its own frame is mirrored
// in x (hand::mirrored): both together are a turn again.
Pose on_side(const Pose& of_right, hand::Side side) {
    if (side == hand::Side::right) return of_right;
    const Quat& q = of_right.orientation;
    return {of_right.position * Vec3(1.0, -1.0, 1.0), Quat(q.w, -q.x, q.y, -q.z) * Quat(0.0, 0.0, 0.0, 1.0)};
}

// Fingertips that press are bent back, and the joints before them bend for it.
hand::Angles pinched_hard(hand::Angles a) {
    for (std::size_t i = 0; i < 2; ++i) {
        a.fingers[i].pip += 16.0 * deg;
        a.fingers[i].dip -= 24.0 * deg;
    }
    a.thumb.mcp += 10.0 * deg;
    a.thumb.ip -= 24.0 * deg;
    return a;
}

// Opened a little.
hand::Angles eased(const hand::Angles& angles) {
    constexpr double of_fingers = 0.86, of_thumb = 0.8;
    hand::Angles a = angles;
    for (hand::FingerAngles& f : a.fingers) f = {of_fingers * f.mcp, of_fingers * f.pip, f.dip, f.side};
    a.thumb.ip *= of_thumb;
    a.thumb.mcp *= of_thumb;
    return a;
}

// Across a handle that lies along the tool's x and is broad in y: the palm from above, the thumb's side
// towards the jaw.
Pose wrist_on_handle(double grip_at) {
    const Pose across = inverse({Vec3(0.0, -28e-3, -98e-3), rotation({0.0, -17.5 * deg, 0.0})});
    const Pose stands{Vec3(0.0), glm::angleAxis(0.5 * pi, Vec3(1, 0, 0))};
    Pose wrist = stands * across;
    wrist.position.x += grip_at;
    return wrist;
}

}  // namespace

Postures make_postures(const collision::ToolShape* wrench, double grip_at, hand::Side side,
                       double nut_width) {
    const hand::Hand hand = hand::make_hand(side);
    Postures postures;
    postures.grip_at = grip_at;
    const Pose on_handle = on_side(wrist_on_handle(grip_at), side);
    const auto closed_on = [&](const Pose& wrist) {
        return wrench != nullptr ? hand::close_fingers(*wrench, hand, closed(1.0), wrist).angles
                                 : closed(0.75);
    };
    for (std::size_t i = 0; i < postures.on_handle.size(); ++i) {
        // Over to the other face, and about the handle's middle to the other end.
        const Quat over = glm::angleAxis((i & 1U) != 0 ? pi : 0.0, Vec3(1, 0, 0));
        const Quat round = glm::angleAxis((i & 2U) != 0 ? pi : 0.0, Vec3(0, 0, 1));
        const Pose middle{Vec3(grip_at, 0.0, 0.0)};
        const Pose wrist = middle * Pose{Vec3(0.0), over * round} * inverse(middle) * on_handle;
        const hand::Angles angles = closed_on(wrist);
        postures.on_handle[i] = hand::joints(hand, angles, wrist);
        postures.at_ease[i] = hand::joints(hand, eased(angles), wrist);
        // About the knuckles, which stay where they are.
        const Vec3 knuckles = postures.on_handle[i].position[hand::middle_proximal];
        const Quat bent = glm::angleAxis(strained_wrist, wrist.orientation * Vec3(1, 0, 0));
        const Pose hard{knuckles + bent * (wrist.position - knuckles), bent * wrist.orientation};
        postures.strained[i] = hand::joints(hand, closed_on(hard), hard);
    }

    // The pads are on either side of the tool's origin, the forearm is on the handle's side.
    const hand::Hand right = hand::make_hand(hand::Side::right);
    const hand::Angles pinch = pinched_on(right, nut_width);
    const Quat over = on_side({Vec3(0.0), over_nut(between_pads(right, pinch))}, side).orientation;
    const auto meeting = [&](const hand::Angles& bent, double lift) {
        const hand::Skeleton flat = hand::joints(hand, bent, Pose{});
        const Vec3 middle = 0.5 * (hand::pad(hand, flat, 0) + hand::pad(hand, flat, 1));
        return hand::joints(hand, bent, Pose{Vec3(0.0, 0.0, lift) - over * middle, over});
    };
    postures.on_nut = meeting(pinch, pad_lift);
    postures.on_nut_strained = meeting(pinched_hard(pinch), pad_lift);
    postures.open = meeting(closed(0.25), 0.02);
    return postures;
}

hand::Skeleton holding(const Postures& postures, std::size_t way, double strain) {
    const double share = 2.0 * std::clamp(strain, 0.0, 1.0);
    return share < 1.0 ? between(postures.at_ease.at(way), postures.on_handle.at(way), share)
                       : between(postures.on_handle.at(way), postures.strained.at(way), share - 1.0);
}

hand::Skeleton pinching(const Postures& postures, double strain) {
    return between(postures.on_nut, postures.on_nut_strained, std::clamp(strain, 0.0, 1.0));
}

std::size_t natural_grip(const Postures& postures, const Pose& tool, const Vec3& up, const Vec3& shoulder) {
    std::size_t best = 0;
    double most = -10.0;
    for (std::size_t i = 0; i < postures.on_handle.size(); ++i) {
        const hand::Skeleton& s = postures.on_handle[i];
        const Quat wrist = tool.orientation * s.rotation[hand::wrist];
        const Vec3 way = shoulder - tool * s.position[hand::wrist];
        const double palm_down = glm::dot(wrist * Vec3(0, 1, 0), up);
        const double forearm = glm::dot(wrist * Vec3(0, 0, 1), way) / glm::length(way);
        if (2.0 * palm_down + forearm <= most) continue;
        most = 2.0 * palm_down + forearm;
        best = i;
    }
    return best;
}

Pose towards(const Pose& tool, const Vec3& shoulder, double twisted) {
    const Vec3 axis = tool.orientation * Vec3(0, 0, 1);
    Vec3 out = shoulder - tool.position;
    out -= axis * glm::dot(out, axis);
    const double length = glm::length(out);
    if (length < 1e-6) return tool;
    const Vec3 x = glm::angleAxis(twisted, axis) * (out / length);
    return {tool.position, glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(axis, x), axis)))};
}

hand::Skeleton between(const hand::Skeleton& a, const hand::Skeleton& b, double share) {
    hand::Skeleton s;
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        s.position[i] = glm::mix(a.position[i], b.position[i], share);
        s.rotation[i] = glm::slerp(a.rotation[i], b.rotation[i], share);
    }
    return s;
}

}  // namespace bolt::scene
