#include "haptics/hand/kinematics.hpp"

#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

constexpr double mm = 1e-3;
constexpr Vec3 along_x(1.0, 0.0, 0.0), along_y(0.0, 1.0, 0.0), along_z(0.0, 0.0, 1.0);
constexpr double ring_share = 20.0 / 27.0;  // of the palm's arch

Quat flexed(double angle) { return glm::angleAxis(-angle, along_x); }

struct Bent {
    const Skeleton& flat;
    Skeleton out;

    // A joint that hangs on another turns by `turn` in its own frame, after `swing` in that of its parent's.
    void hang(std::size_t joint, std::size_t parent, const Quat& swing, const Quat& turn) {
        const Quat back = glm::conjugate(flat.rotation[parent]);
        out.position[joint] = out.position[parent] +
                              out.rotation[parent] * (back * (flat.position[joint] - flat.position[parent]));
        out.rotation[joint] =
            glm::normalize(out.rotation[parent] * swing * (back * flat.rotation[joint]) * turn);
    }
    void keep(std::size_t joint, std::size_t parent) {
        hang(joint, parent, Quat(1.0, 0.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0));
    }
};

void bend_thumb(Bent& hand, const ThumbAngles& angles) {
    // In the wrist's frame: to the thumb's side is −X, across the palm is from there to −Y.
    const Quat swing = glm::angleAxis(angles.roll, along_z) * glm::angleAxis(angles.abduction, along_y);
    hand.hang(thumb_metacarpal, wrist, swing, Quat(1.0, 0.0, 0.0, 0.0));
    hand.hang(thumb_proximal, thumb_metacarpal, Quat(1.0, 0.0, 0.0, 0.0), flexed(angles.mcp));
    hand.hang(thumb_distal, thumb_proximal, Quat(1.0, 0.0, 0.0, 0.0), flexed(angles.ip));
    hand.keep(thumb_tip, thumb_distal);
}

void bend_finger(Bent& hand, std::size_t first, const FingerAngles& angles, double arch, double to_little) {
    const Quat none(1.0, 0.0, 0.0, 0.0);
    hand.hang(first, wrist, none, flexed(arch));
    hand.hang(first + 1, first, glm::angleAxis(-to_little * angles.side, along_y), flexed(angles.mcp));
    hand.hang(first + 2, first + 1, none, flexed(angles.pip));
    hand.hang(first + 3, first + 2, none, flexed(angles.dip));
    hand.keep(first + 4, first + 3);
}

}  // namespace

Hand make_hand(Side side, double length) { return {side, length / skeleton_length, flat_right_skeleton()}; }

Skeleton joints(const Hand& hand, const Angles& angles, const Pose& wrist_pose) {
    Bent bent{hand.flat, {}};
    bent.out.position[wrist] = hand.flat.position[wrist];
    bent.out.rotation[wrist] = hand.flat.rotation[wrist];
    bent.keep(palm, wrist);
    bend_thumb(bent, angles.thumb);
    const std::array<double, 4> arch{0.0, 0.0, ring_share * angles.arch, angles.arch};
    const std::array<double, 4> to_little{-1.0, 1.0, 1.0, 1.0};
    for (std::size_t i = 0; i < angles.fingers.size(); ++i)
        bend_finger(bent, digits[i + 1].first, angles.fingers[i], arch[i], to_little[i]);
    Skeleton out = hand.side == Side::right ? bent.out : mirrored(bent.out);
    for (std::size_t i = 0; i < joint_count; ++i) {
        out.position[i] = wrist_pose * (hand.scale * out.position[i]);
        out.rotation[i] = glm::normalize(wrist_pose.orientation * out.rotation[i]);
    }
    return out;
}

Pose wrist_of(const Hand& hand, const Angles& angles, const Pose& forearm) {
    const double to_thumb = hand.side == Side::right ? angles.wrist_side : -angles.wrist_side;
    return {forearm.position, glm::normalize(forearm.orientation * flexed(angles.wrist_flexion) *
                                             glm::angleAxis(to_thumb, along_y))};
}

Tube tube(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone) {
    const std::size_t joint = digits[digit].first + bone;
    const auto& breadth = half_breadths_mm[digit];
    Tube tube{joints.position[joint], joints.position[joint + 1], hand.scale * breadth[bone] * mm,
              hand.scale * breadth[bone + 1] * mm};
    if (bone + 2 == digits[digit].count)  // the last ends at the tip of the glove
        tube.to += joints.rotation[joint] * Vec3(0.0, 0.0, tube.radius_to - hand.scale * glove_mm * mm);
    return tube;
}

Vec3 pad(const Hand& hand, const Skeleton& joints, std::size_t digit) {
    const std::size_t bone = digits[digit].count - 2;
    const Tube last = tube(hand, joints, digit, bone);
    const double radius = 0.5 * (last.radius_from + last.radius_to);
    const Vec3 to_palm = joints.rotation[digits[digit].first + bone] * Vec3(0.0, -1.0, 0.0);
    return 0.45 * last.from + 0.55 * last.to + to_palm * (radius - hand.scale * pad_radius);
}

}  // namespace bolt::hand
