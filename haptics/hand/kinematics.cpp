#include "haptics/hand/kinematics.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

double clamp_to_range(const AngleRange& span, double angle) {
    return std::isfinite(angle) ? std::clamp(angle, span.low, span.high) : 0.0;
}

}  // namespace

Angles clamp_to_limits(const Angles& angles) {
    Angles out;
    out.thumb = {clamp_to_range(thumb_roll_range, angles.thumb.roll),
                 clamp_to_range(thumb_abduction_range, angles.thumb.abduction),
                 clamp_to_range(thumb_mcp_range, angles.thumb.mcp),
                 clamp_to_range(thumb_ip_range, angles.thumb.ip)};
    for (std::size_t i = 0; i < out.fingers.size(); ++i) {
        const FingerAngles& from = angles.fingers[i];
        FingerAngles& to = out.fingers[i];
        to.mcp = clamp_to_range(mcp_range, from.mcp);
        to.pip = clamp_to_range(pip_range, from.pip);
        to.dip = clamp_to_range(dip_range, from.dip);
        const double share = std::clamp(1.0 - to.mcp / (0.5 * pi), 0.0, 1.0);
        to.abduction =
            clamp_to_range({abduction_range.low * share, abduction_range.high * share}, from.abduction);
    }
    out.arch = clamp_to_range(arch_range, angles.arch);
    out.wrist_flexion = clamp_to_range(wrist_flexion_range, angles.wrist_flexion);
    out.wrist_deviation = clamp_to_range(wrist_deviation_range, angles.wrist_deviation);
    return out;
}

namespace {

Quat frame(const Vec3& forward, const Vec3& up) {
    const Vec3 z = -glm::normalize(forward);
    const Vec3 x = glm::normalize(glm::cross(up, z));
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

struct Bones {
    std::size_t first;                // joint of the metacarpal
    Vec3 base_mm;                     // its position
    std::array<double, 4> length_mm;  // metacarpal, proximal, middle and distal phalanx
    double tissue_mm;                 // beyond the bone at the tip
};
constexpr std::array<Bones, 4> bones{{
    {index_metacarpal, {-13.5, 1.0, -30.0}, {68.12, 39.78, 22.38, 15.82}, 3.84},
    {middle_metacarpal, {-2.0, 2.5, -32.0}, {64.60, 44.63, 26.33, 17.40}, 3.95},
    {ring_metacarpal, {9.0, 1.5, -30.0}, {58.00, 41.37, 25.65, 17.30}, 3.95},
    {little_metacarpal, {18.5, -0.5, -27.0}, {53.69, 32.74, 18.11, 15.96}, 3.73},
}};

// Angles at rest, degrees. A turn and a roll are positive to the little finger, a drop to the palm.
struct Rest {
    double metacarpal_turn, metacarpal_drop, turn, roll;
    std::array<double, 3> flexion;
};
constexpr std::array<Rest, 4> rest{{
    {-9.0, 0.0, -9.5, -5.0, {7, 13, 8}},
    {-1.5, 0.5, -0.5, 0.0, {8, 14, 8}},
    {6.8, 1.5, 9.0, 4.0, {9, 15, 9}},
    {15.5, 4.0, 21.0, 9.0, {9, 15, 9}},
}};

Vec3 direction(double turn_deg, double drop_deg) {
    const double turn = to_radians(turn_deg);
    const double drop = to_radians(drop_deg);
    return {std::sin(turn) * std::cos(drop), -std::sin(drop), -std::cos(turn) * std::cos(drop)};
}

void place_finger(Skeleton& hand, const Bones& finger, const Rest& angles) {
    const Vec3 up(std::sin(to_radians(angles.roll)), std::cos(to_radians(angles.roll)), 0.0);
    Vec3 at = finger.base_mm * mm;
    double drop = angles.metacarpal_drop;
    for (std::size_t bone = 0; bone < 4; ++bone) {
        if (bone > 0) drop += angles.flexion[bone - 1];
        const Vec3 forward = direction(bone == 0 ? angles.metacarpal_turn : angles.turn, drop);
        const std::size_t joint = finger.first + bone;
        hand.position[joint] = at;
        hand.rotation[joint] = frame(forward, up);
        at += forward * ((finger.length_mm[bone] + (bone == 3 ? finger.tissue_mm : 0.0)) * mm);
    }
    hand.position[finger.first + 4] = at;
    hand.rotation[finger.first + 4] = hand.rotation[finger.first + 3];
}

struct Thumb {
    std::array<Vec3, 3> forward;
    Vec3 up;
};

// At rest the metacarpal points out of the palm's plane, and the nail faces sideways.
Thumb thumb_at_rest() {
    return {{glm::normalize(Vec3(-0.60, -0.36, -0.72)), glm::normalize(Vec3(-0.47, -0.29, -0.84)),
             glm::normalize(Vec3(-0.36, -0.23, -0.90))},
            Vec3(-0.72, 0.69, 0.0)};
}

// The thumb lies beside the index finger, in contact with its flesh. The nail's roll at rest is reduced by
// the angle of the metacarpal to the palm's plane (31°).
Thumb flat_thumb() {
    return {{direction(-15.0, 0.0), direction(-15.0, 0.0), direction(-15.0, 0.0)}, Vec3(-0.26, 0.965, 0.0)};
}

void place_thumb(Skeleton& hand, const Thumb& thumb) {
    const std::array<double, 3> length_mm{46.22, 31.57, 21.67 + 5.67};
    Vec3 at = Vec3(-19.0, -7.0, -17.0) * mm;
    for (std::size_t bone = 0; bone < 3; ++bone) {
        hand.position[thumb_metacarpal + bone] = at;
        hand.rotation[thumb_metacarpal + bone] = frame(thumb.forward[bone], thumb.up);
        at += thumb.forward[bone] * (length_mm[bone] * mm);
    }
    hand.position[thumb_tip] = at;
    hand.rotation[thumb_tip] = hand.rotation[thumb_distal];
}

Skeleton place(const Thumb& thumb, const std::array<Rest, 4>& fingers) {
    Skeleton hand;
    hand.position[wrist] = Vec3(0.0);
    hand.rotation[wrist] = Quat(1.0, 0.0, 0.0, 0.0);
    place_thumb(hand, thumb);
    for (std::size_t i = 0; i < bones.size(); ++i) place_finger(hand, bones[i], fingers[i]);
    // The palm joint is the middle of the middle finger's metacarpal.
    hand.position[palm] = 0.5 * (hand.position[middle_metacarpal] + hand.position[middle_proximal]);
    hand.rotation[palm] = hand.rotation[middle_metacarpal];
    return hand;
}

}  // namespace

Skeleton right_skeleton() { return place(thumb_at_rest(), rest); }

Skeleton flat_right_skeleton() {
    std::array<Rest, 4> flat = rest;
    for (Rest& finger : flat) {
        finger.turn = rest[1].turn;
        finger.flexion = {-finger.metacarpal_drop, 0.0, 0.0};
    }
    return place(flat_thumb(), flat);
}

Skeleton mirrored(const Skeleton& skeleton) {
    Skeleton out = skeleton;
    for (Vec3& p : out.position) p.x = -p.x;
    for (Quat& q : out.rotation) q = mirrored(q);
    return out;
}

namespace {

constexpr Vec3 along_x(1.0, 0.0, 0.0), along_y(0.0, 1.0, 0.0), along_z(0.0, 0.0, 1.0);
constexpr double ring_share = 20.0 / 27.0;  // of the palm's arch

Quat flexed(double angle) { return glm::angleAxis(-angle, along_x); }

const Quat no_rotation(1.0, 0.0, 0.0, 0.0);

// Poses a right hand of scale 1 joint by joint, in the wrist frame.
struct DigitPose {
    const Skeleton& flat;
    std::array<Pose, 6> at{};  // the wrist, then the digit's joints
    std::size_t first = 0;     // the digit's

    explicit DigitPose(const Skeleton& skeleton) : flat(skeleton) {}

    // Rotates the digit's next joint by `swing` in its parent's frame, then by `turn` in its own.
    void attach(std::size_t k, const Quat& swing, const Quat& turn) {
        const std::size_t joint = first + k, parent = k == 0 ? static_cast<std::size_t>(wrist) : joint - 1;
        const Quat back = glm::conjugate(flat.rotation[parent]);
        const Pose& on = at[k];
        at[k + 1] = {on * (back * (flat.position[joint] - flat.position[parent])),
                     glm::normalize(on.orientation * swing * (back * flat.rotation[joint]) * turn)};
    }
};

void pose_thumb(DigitPose& hand, const ThumbAngles& angles) {
    // Wrist frame: −X points to the thumb's side, −Y out of the palm.
    hand.attach(0, glm::angleAxis(angles.roll, along_z) * glm::angleAxis(angles.abduction, along_y),
                no_rotation);
    hand.attach(1, no_rotation, flexed(angles.mcp));
    hand.attach(2, no_rotation, flexed(angles.ip));
    hand.attach(3, no_rotation, no_rotation);
}

void pose_finger(DigitPose& hand, const FingerAngles& angles, double arch, double to_little) {
    hand.attach(0, no_rotation, flexed(arch));
    hand.attach(1, glm::angleAxis(-to_little * angles.abduction, along_y), flexed(angles.mcp));
    hand.attach(2, no_rotation, flexed(angles.pip));
    hand.attach(3, no_rotation, flexed(angles.dip));
    hand.attach(4, no_rotation, no_rotation);
}

// Maps a joint of a right hand of scale 1 to this hand and wrist pose.
void write_joint(const Hand& hand, const Pose& wrist_pose, std::size_t joint, const Pose& at, Skeleton& out) {
    const bool right = hand.side == Side::right;
    const Pose on_side = right ? at : mirrored(at);
    out.position[joint] = wrist_pose * (hand.scale * on_side.position);
    out.rotation[joint] = glm::normalize(wrist_pose.orientation * on_side.orientation);
}

}  // namespace

Hand make_hand(Side side, double length) { return {side, length / skeleton_length, flat_right_skeleton()}; }

void place_digit(const Hand& hand, const Angles& angles, const Pose& wrist_pose, std::size_t digit,
                 Skeleton& out) {
    constexpr std::array<double, 5> arch{0.0, 0.0, 0.0, ring_share, 1.0};
    DigitPose bent(hand.flat);
    bent.first = digits[digit].first;
    if (digit == 0)
        pose_thumb(bent, angles.thumb);
    else
        pose_finger(bent, angles.fingers[digit - 1], arch[digit] * angles.arch, digit == 1 ? -1.0 : 1.0);
    for (std::size_t k = 0; k < digits[digit].count; ++k)
        write_joint(hand, wrist_pose, bent.first + k, bent.at[k + 1], out);
}

Skeleton joints(const Hand& hand, const Angles& angles, const Pose& wrist_pose) {
    Skeleton out;
    for (const std::size_t joint : {wrist, palm})
        write_joint(hand, wrist_pose, joint, {hand.flat.position[joint], hand.flat.rotation[joint]}, out);
    for (std::size_t digit = 0; digit < digit_count; ++digit)
        place_digit(hand, angles, wrist_pose, digit, out);
    return out;
}

Pose wrist_of(const Hand& hand, const Angles& angles, const Pose& forearm) {
    const double to_thumb = hand.side == Side::right ? angles.wrist_deviation : -angles.wrist_deviation;
    return {forearm.position, glm::normalize(forearm.orientation * flexed(angles.wrist_flexion) *
                                             glm::angleAxis(to_thumb, along_y))};
}

Capsule bone_capsule(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone) {
    const std::size_t joint = digits[digit].first + bone;
    const auto& breadth = half_breadths_mm[digit];
    Capsule capsule{joints.position[joint], joints.position[joint + 1], hand.scale * breadth[bone] * mm,
                    hand.scale * breadth[bone + 1] * mm};
    if (bone + 2 == digits[digit].count)  // the last bone ends at the tip of the glove
        capsule.to += joints.rotation[joint] * Vec3(0.0, 0.0, capsule.radius_to - hand.scale * glove_mm * mm);
    return capsule;
}

Vec3 fingertip_pad_centre(const Hand& hand, const Skeleton& joints, std::size_t digit) {
    const std::size_t bone = digits[digit].count - 2;
    const Capsule last = bone_capsule(hand, joints, digit, bone);
    const double radius = 0.5 * (last.radius_from + last.radius_to);
    const Vec3 to_palm = joints.rotation[digits[digit].first + bone] * Vec3(0.0, -1.0, 0.0);
    return 0.45 * last.from + 0.55 * last.to + to_palm * (radius - hand.scale * pad_radius);
}

}  // namespace bolt::hand
