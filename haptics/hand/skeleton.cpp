#include "haptics/hand/skeleton.hpp"

#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

constexpr double mm = 1e-3;

Quat frame(const Vec3& forward, const Vec3& up) {
    const Vec3 z = -glm::normalize(forward);
    const Vec3 x = glm::normalize(glm::cross(up, z));
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

struct Bones {
    std::size_t first;                // joint of the metacarpal
    Vec3 base_mm;                     // where it stands
    std::array<double, 4> length_mm;  // metacarpal, proximal, middle and distal phalanx
    double tissue_mm;                 // beyond the bone at the tip
};
constexpr std::array<Bones, 4> bones{{
    {index_metacarpal, {-13.5, 1.0, -30.0}, {68.12, 39.78, 22.38, 15.82}, 3.84},
    {middle_metacarpal, {-2.0, 2.5, -32.0}, {64.60, 44.63, 26.33, 17.40}, 3.95},
    {ring_metacarpal, {9.0, 1.5, -30.0}, {58.00, 41.37, 25.65, 17.30}, 3.95},
    {little_metacarpal, {18.5, -0.5, -27.0}, {53.69, 32.74, 18.11, 15.96}, 3.73},
}};

// Degrees at rest: yaw to the little finger, pitch to the palm, roll to the little finger, flexion.
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

// The metacarpal leaves the plane of the palm, and the nail faces sideways.
Thumb thumb_at_rest() {
    return {{glm::normalize(Vec3(-0.60, -0.36, -0.72)), glm::normalize(Vec3(-0.47, -0.29, -0.84)),
             glm::normalize(Vec3(-0.36, -0.23, -0.90))},
            Vec3(-0.72, 0.69, 0.0)};
}

// Beside the index finger, in contact with its flesh. The nail's roll at rest is reduced by the angle of the
// metacarpal to the palm's plane (31°).
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
    for (Quat& q : out.rotation) q = Quat(q.w, q.x, -q.y, -q.z);
    return out;
}

}  // namespace bolt::hand
