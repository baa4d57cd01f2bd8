#include "haptics/hand/kinematics.hpp"

#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

constexpr double mm = 1e-3;
constexpr Vec3 along_x(1.0, 0.0, 0.0), along_y(0.0, 1.0, 0.0), along_z(0.0, 0.0, 1.0);
constexpr double ring_share = 20.0 / 27.0;  // of the palm's arch

Quat flexed(double angle) { return glm::angleAxis(-angle, along_x); }

const Quat none(1.0, 0.0, 0.0, 0.0);

// Poses a right hand of scale 1 joint by joint, in the wrist frame.
struct Bending {
    const Skeleton& flat;
    std::array<Pose, 6> at{};  // the wrist, then the digit's joints
    std::size_t first = 0;     // the digit's

    explicit Bending(const Skeleton& skeleton) : flat(skeleton) {}

    // Rotates the digit's next joint by `swing` in its parent's frame, then by `turn` in its own.
    void hang(std::size_t k, const Quat& swing, const Quat& turn) {
        const std::size_t joint = first + k, parent = k == 0 ? static_cast<std::size_t>(wrist) : joint - 1;
        const Quat back = glm::conjugate(flat.rotation[parent]);
        const Pose& on = at[k];
        at[k + 1] = {on * (back * (flat.position[joint] - flat.position[parent])),
                     glm::normalize(on.orientation * swing * (back * flat.rotation[joint]) * turn)};
    }
};

void bend_thumb(Bending& hand, const ThumbAngles& angles) {
    // Wrist frame: −X points to the thumb's side, −Y out of the palm.
    hand.hang(0, glm::angleAxis(angles.roll, along_z) * glm::angleAxis(angles.abduction, along_y), none);
    hand.hang(1, none, flexed(angles.mcp));
    hand.hang(2, none, flexed(angles.ip));
    hand.hang(3, none, none);
}

void bend_finger(Bending& hand, const FingerAngles& angles, double arch, double to_little) {
    hand.hang(0, none, flexed(arch));
    hand.hang(1, glm::angleAxis(-to_little * angles.side, along_y), flexed(angles.mcp));
    hand.hang(2, none, flexed(angles.pip));
    hand.hang(3, none, flexed(angles.dip));
    hand.hang(4, none, none);
}

// Maps a joint of the unit right hand to this hand and wrist pose.
void put(const Hand& hand, const Pose& wrist_pose, std::size_t joint, const Pose& at, Skeleton& out) {
    const bool right = hand.side == Side::right;
    const Quat& q = at.orientation;
    const Vec3 position = right ? at.position : at.position * Vec3(-1.0, 1.0, 1.0);
    out.position[joint] = wrist_pose * (hand.scale * position);
    out.rotation[joint] = glm::normalize(wrist_pose.orientation * (right ? q : Quat(q.w, q.x, -q.y, -q.z)));
}

}  // namespace

Hand make_hand(Side side, double length) { return {side, length / skeleton_length, flat_right_skeleton()}; }

void place_digit(const Hand& hand, const Angles& angles, const Pose& wrist_pose, std::size_t digit,
                 Skeleton& out) {
    constexpr std::array<double, 5> arch{0.0, 0.0, 0.0, ring_share, 1.0};
    Bending bent(hand.flat);
    bent.first = digits[digit].first;
    if (digit == 0)
        bend_thumb(bent, angles.thumb);
    else
        bend_finger(bent, angles.fingers[digit - 1], arch[digit] * angles.arch, digit == 1 ? -1.0 : 1.0);
    for (std::size_t k = 0; k < digits[digit].count; ++k)
        put(hand, wrist_pose, bent.first + k, bent.at[k + 1], out);
}

Skeleton joints(const Hand& hand, const Angles& angles, const Pose& wrist_pose) {
    Skeleton out;
    for (const std::size_t joint : {wrist, palm})
        put(hand, wrist_pose, joint, {hand.flat.position[joint], hand.flat.rotation[joint]}, out);
    for (std::size_t digit = 0; digit < digit_count; ++digit)
        place_digit(hand, angles, wrist_pose, digit, out);
    return out;
}

Pose wrist_of(const Hand& hand, const Angles& angles, const Pose& forearm) {
    const double to_thumb = hand.side == Side::right ? angles.wrist_side : -angles.wrist_side;
    return {forearm.position, glm::normalize(forearm.orientation * flexed(angles.wrist_flexion) *
                                             glm::angleAxis(to_thumb, along_y))};
}

Capsule tube(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone) {
    const std::size_t joint = digits[digit].first + bone;
    const auto& breadth = half_breadths_mm[digit];
    Capsule tube{joints.position[joint], joints.position[joint + 1], hand.scale * breadth[bone] * mm,
                 hand.scale * breadth[bone + 1] * mm};
    if (bone + 2 == digits[digit].count)  // the last ends at the tip of the glove
        tube.to += joints.rotation[joint] * Vec3(0.0, 0.0, tube.radius_to - hand.scale * glove_mm * mm);
    return tube;
}

Vec3 pad(const Hand& hand, const Skeleton& joints, std::size_t digit) {
    const std::size_t bone = digits[digit].count - 2;
    const Capsule last = tube(hand, joints, digit, bone);
    const double radius = 0.5 * (last.radius_from + last.radius_to);
    const Vec3 to_palm = joints.rotation[digits[digit].first + bone] * Vec3(0.0, -1.0, 0.0);
    return 0.45 * last.from + 0.55 * last.to + to_palm * (radius - hand.scale * pad_radius);
}

}  // namespace bolt::hand
