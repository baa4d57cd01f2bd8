#include "game/scene/postures.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::scene {

namespace {

constexpr double slow_time = 0.09, fast_time = 0.012;  // s, time constants
constexpr double tremor_gain = 6.0;
constexpr double rest = 1e-3;  // effort below which it is reset to zero

// First-order low-pass filter.
void filter(double& value, double to, double dt, double time) {
    value += (to - value) * (1.0 - std::exp(-dt / time));
}

}  // namespace

double relative_torque(const servo::Setup& setup, const EffortAccess& world) {
    const std::int16_t engaged = world.only<world::ToolState>().joint;
    if (engaged < 0) return 0.0;
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(engaged));
    const double most = world.only<world::WorkingHand>().wrench
                            ? setup.wrench.stiffness * to_radians(2.5)
                            : setup.finger_torque(setup.nuts[joint.index]);
    return std::clamp(joint.torque / most, -1.0, 1.0);
}

void update_effort(Effort& effort, const servo::Setup& setup, const EffortAccess& world) {
    const double now = relative_torque(setup, world);
    filter(effort.fast, now, setup.dt, fast_time);
    filter(effort.slow, now, setup.dt, slow_time);
    filter(effort.share, std::abs(now), setup.dt, slow_time);
    effort.tremor =
        std::clamp(tremor_gain * (effort.fast - effort.slow), -1.0, 1.0) * std::min(1.0, 3.0 * effort.share);
    if (now == 0.0 && effort.share < rest && std::abs(effort.slow) < rest && std::abs(effort.fast) < rest)
        effort = {};
}

namespace {

constexpr double deg = pi / 180.0;
constexpr double glove = 2.5e-3;   // m, thickness of the displayed glove over the finger pads
constexpr double pad_lift = 3e-3;  // m, of the pads above the nut's centre, so that they clear its seat
constexpr double strained_wrist = 11.0 * deg;

// Fingers bent by a fraction of a fist's angles, the thumb opposed; tuned by eye.
hand::Angles closed(double share) {
    hand::Angles a;
    for (hand::FingerAngles& f : a.fingers)
        f = {share * 70.0 * deg, share * 95.0 * deg, share * 60.0 * deg, 0.0};
    a.thumb = {70.0 * deg, (60.0 - 48.0 * share) * deg, share * 50.0 * deg, share * 65.0 * deg};
    a.arch = 8.0 * deg;
    return a;
}

// Thumb against index and middle finger; the other two are stretched to clear the surroundings of the nut.
hand::Angles pinch_angles(double thumb_abduction) {
    hand::Angles a = closed(0.25);
    a.fingers[0] = {62.0 * deg, 32.0 * deg, 14.0 * deg, 0.0};
    a.fingers[1] = {64.0 * deg, 34.0 * deg, 16.0 * deg, 0.0};
    a.thumb = {80.0 * deg, thumb_abduction, 4.0 * deg, 8.0 * deg};
    return a;
}

// The vector from the pad of the thumb to that of the index finger, in the frame of the wrist.
Vec3 between_pads(const hand::Hand& hand, const hand::Angles& angles) {
    const hand::Skeleton joints = hand::joints(hand, angles, Pose{});
    return hand::fingertip_pad_centre(hand, joints, 1) - hand::fingertip_pad_centre(hand, joints, 0);
}

// The pinch whose pads touch the corners of a nut of that width (m across flats): the nut turns between the
// pads. Found by bisection of the thumb's abduction.
hand::Angles pinch_for_width(const hand::Hand& hand, double width) {
    const double goal = 2.0 / std::sqrt(3.0) * width + 2.0 * (hand::pad_radius + glove);
    double narrow = 5.0 * deg, wide = 65.0 * deg;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (narrow + wide);
        (glm::length(between_pads(hand, pinch_angles(middle))) < goal ? narrow : wide) = middle;
    }
    return pinch_angles(0.5 * (narrow + wide));
}

// The rotation of a right wrist that puts the line between the pads along −x and the back of the hand up
// (+z).
Quat wrist_over_nut(const Vec3& between_pads) {
    const Vec3 line = glm::normalize(between_pads);
    const Vec3 back = glm::normalize(Vec3(0, 1, 0) - line.y * line);
    const glm::dmat3 own(line, back, glm::cross(line, back));
    const glm::dmat3 goal(Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0));
    return glm::normalize(glm::quat_cast(goal * glm::transpose(own)));
}

// Converts the pose of a right wrist for a left one: mirrored in the tool's plane y = 0, with a frame
// mirrored in x (hand::mirrored). The two reflections make a rotation.
Pose on_side(const Pose& of_right, hand::Side side) {
    if (side == hand::Side::right) return of_right;
    const Quat& q = of_right.orientation;
    return {of_right.position * Vec3(1.0, -1.0, 1.0), Quat(q.w, -q.x, q.y, -q.z) * Quat(0.0, 0.0, 0.0, 1.0)};
}

// Shows pressure on the pads: extends the last joint of thumb, index and middle finger, and flexes the one
// before it.
hand::Angles pressed(hand::Angles a) {
    for (std::size_t i = 0; i < 2; ++i) {
        a.fingers[i].pip += 16.0 * deg;
        a.fingers[i].dip -= 24.0 * deg;
    }
    a.thumb.mcp += 10.0 * deg;
    a.thumb.ip -= 24.0 * deg;
    return a;
}

// Opens the fingers slightly.
hand::Angles relaxed_angles(const hand::Angles& angles) {
    constexpr double of_fingers = 0.86, of_thumb = 0.8;
    hand::Angles a = angles;
    for (hand::FingerAngles& f : a.fingers) f = {of_fingers * f.mcp, of_fingers * f.pip, f.dip, f.abduction};
    a.thumb.ip *= of_thumb;
    a.thumb.mcp *= of_thumb;
    return a;
}

// The pose of the wrist when the hand grips the handle from above, the thumb towards the jaw. The handle is
// along the tool's x and broad in y; its middle is at `grip`.
Pose wrist_on_handle(const Vec3& grip) {
    const Pose across = inverse({Vec3(0.0, -28e-3, -98e-3), rotation({0.0, -17.5 * deg, 0.0})});
    const Pose upright{Vec3(0.0), glm::angleAxis(0.5 * pi, Vec3(1, 0, 0))};
    Pose wrist = upright * across;
    wrist.position += grip;
    return wrist;
}

// The middle of the handle where the hand grips it. The handles of sockets, keys and cranked rings are above
// the head; a small height is only the shape of the handle.
Vec3 middle_of_handle(const collision::ToolShape* wrench, double grip_distance) {
    constexpr double half_width = 0.02, small = 5e-3;  // m
    double low = 1e9, high = -1e9;
    if (wrench != nullptr)
        for (const auto& triangle : wrench->solid.corners)
            for (const Vec3 p : triangle)
                if (std::abs(p.x - grip_distance) < half_width) {
                    low = std::min(low, p.z);
                    high = std::max(high, p.z);
                }
    const double height = low <= high ? 0.5 * (low + high) : 0.0;
    return {grip_distance, 0.0, std::abs(height) > small ? height : 0.0};
}

}  // namespace

Postures make_postures(const collision::ToolShape* wrench, double grip_distance, hand::Side side,
                       double nut_width) {
    const hand::Hand hand = hand::make_hand(side);
    Postures postures;
    postures.grip_distance = grip_distance;
    const Vec3 grip = middle_of_handle(wrench, grip_distance);
    const Pose on_handle = on_side(wrist_on_handle(grip), side);
    const auto closed_angles = [&](const Pose& wrist) {
        return wrench != nullptr ? hand::close_fingers(*wrench, hand, closed(1.0), wrist).angles
                                 : closed(0.75);
    };
    for (std::size_t i = 0; i < postures.on_handle.size(); ++i) {
        // Rotations to the other face, and about the middle of the handle to the other direction.
        const Quat over = glm::angleAxis((i & 1U) != 0 ? pi : 0.0, Vec3(1, 0, 0));
        const Quat round = glm::angleAxis((i & 2U) != 0 ? pi : 0.0, Vec3(0, 0, 1));
        const Pose middle{grip};
        const Pose wrist = middle * Pose{Vec3(0.0), over * round} * inverse(middle) * on_handle;
        const hand::Angles angles = closed_angles(wrist);
        postures.on_handle[i] = hand::joints(hand, angles, wrist);
        postures.relaxed[i] = hand::joints(hand, relaxed_angles(angles), wrist);
        // Rotates the wrist about the knuckles.
        const Vec3 knuckles = postures.on_handle[i].position[hand::middle_proximal];
        const Quat bent = glm::angleAxis(strained_wrist, wrist.orientation * Vec3(1, 0, 0));
        const Pose hard{knuckles + bent * (wrist.position - knuckles), bent * wrist.orientation};
        postures.strained[i] = hand::joints(hand, closed_angles(hard), hard);
    }

    // The pads lie on either side of the tool's origin, and the forearm on the side of the handle.
    const hand::Hand right = hand::make_hand(hand::Side::right);
    const hand::Angles pinch = pinch_for_width(right, nut_width);
    const Quat over = on_side({Vec3(0.0), wrist_over_nut(between_pads(right, pinch))}, side).orientation;
    const auto centred = [&](const hand::Angles& angles, double lift) {
        const hand::Skeleton flat = hand::joints(hand, angles, Pose{});
        const Vec3 middle =
            0.5 * (hand::fingertip_pad_centre(hand, flat, 0) + hand::fingertip_pad_centre(hand, flat, 1));
        return hand::joints(hand, angles, Pose{Vec3(0.0, 0.0, lift) - over * middle, over});
    };
    postures.on_nut = centred(pinch, pad_lift);
    postures.on_nut_strained = centred(pressed(pinch), pad_lift);
    postures.open = centred(closed(0.25), 0.02);
    return postures;
}

std::vector<Postures> postures_of_tools(const servo::Setup& setup, const servo::State& state,
                                        hand::Side side) {
    double widest = 0.0;
    for (const servo::NutGeometry& nut : setup.nuts) widest = std::max(widest, nut.across_flats);
    std::vector<Postures> postures;
    for (std::size_t i = 0; i < setup.tools.size(); ++i) {
        const collision::ToolShape* shape = nullptr;
        if (state.tool_contact)
            shape = i == setup.tool ? &state.tool_contact->wrench : &state.tool_contact->tools[i].shape;
        postures.push_back(make_postures(shape, setup.tools[i].wrench.handle_length, side, widest));
    }
    return postures;
}

hand::Skeleton handle_posture(const Postures& postures, std::size_t index, double effort) {
    const double share = 2.0 * std::clamp(effort, 0.0, 1.0);
    return share < 1.0 ? interpolate(postures.relaxed.at(index), postures.on_handle.at(index), share)
                       : interpolate(postures.on_handle.at(index), postures.strained.at(index), share - 1.0);
}

hand::Skeleton pinch_posture(const Postures& postures, double effort) {
    return interpolate(postures.on_nut, postures.on_nut_strained, std::clamp(effort, 0.0, 1.0));
}

std::size_t natural_handle_posture(const Postures& postures, const Pose& tool, const Vec3& up,
                                   const Vec3& shoulder) {
    std::size_t best = 0;
    double most = -10.0;
    for (std::size_t i = 0; i < postures.on_handle.size(); ++i) {
        const hand::Skeleton& s = postures.on_handle[i];
        const Quat wrist = tool.orientation * s.rotation[hand::wrist];
        const Vec3 arm = shoulder - tool * s.position[hand::wrist];
        const double palm_down = glm::dot(wrist * Vec3(0, 1, 0), up);
        const double forearm = glm::dot(wrist * Vec3(0, 0, 1), arm) / glm::length(arm);
        if (2.0 * palm_down + forearm <= most) continue;
        most = 2.0 * palm_down + forearm;
        best = i;
    }
    return best;
}

Pose frame_towards(const Pose& tool, const Vec3& shoulder, double twisted) {
    const Vec3 axis = tool.orientation * Vec3(0, 0, 1);
    Vec3 out = shoulder - tool.position;
    out -= axis * glm::dot(out, axis);
    const double length = glm::length(out);
    if (length < 1e-6) return tool;
    const Vec3 x = glm::angleAxis(twisted, axis) * (out / length);
    return {tool.position, glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(axis, x), axis)))};
}

hand::Skeleton interpolate(const hand::Skeleton& a, const hand::Skeleton& b, double share) {
    hand::Skeleton s;
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        s.position[i] = glm::mix(a.position[i], b.position[i], share);
        s.rotation[i] = glm::slerp(a.rotation[i], b.rotation[i], share);
    }
    return s;
}

}  // namespace bolt::scene
