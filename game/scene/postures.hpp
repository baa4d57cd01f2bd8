// The postures of the hand on the screen for a trainee without a glove, and the effort of this hand. The hand
// strains and trembles with the torque on the nut, so that a trainee sees a torque that no device renders.
// They depend on the output of the ticks and on the place of the shoulder, so a replay shows nearly the same
// hand: it does not know whether the trainee sits, and its hand does not tremble.
#pragma once

#include <array>

#include "game/world/world.hpp"
#include "haptics/hand/finger_closure.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::scene {

struct Effort {
    double share = 0.0;   // 0 at rest … 1 at the greatest torque of the hand; low-pass filtered
    double tremor = 0.0;  // −1 … 1, from torque changes faster than the hand follows
    double fast = 0.0;    // relative torque, signed, with a short and a long filter time constant
    double slow = 0.0;
};

// The torque on the nut relative to the greatest torque of the hand, −1 … 1, tightening positive; 0 if no nut
// is engaged. With a wrench the greatest torque is that of its spring at 2.5°; without one, the torque at
// which the fingers slip.
using EffortAccess = ecs::Access<const world::Joint, const world::ToolState, const world::WorkingHand>;
double relative_torque(const servo::Setup& setup, const EffortAccess& world);

// Call it once a tick.
void update_effort(Effort& effort, const servo::Setup& setup, const EffortAccess& world);

// Skeletons of the 26 joints in the frame of the tool (servo::CommandedTool). There are four postures at a
// handle: the palm on either face, the thumb towards the jaw or away from it.
struct Postures {
    std::array<hand::Skeleton, 4> on_handle;
    hand::Skeleton on_nut, open;
    // At the handle. `relaxed`: without effort, the fingers slightly opened. `strained`: at the greatest
    // effort, the wrist bent over the handle.
    std::array<hand::Skeleton, 4> relaxed, strained;
    hand::Skeleton on_nut_strained;  // at the greatest effort: the fingertips bent back
    double grip_distance = 0.0;      // m, from the jaw's centre along the handle
};

// The posture at an effort of 0 … 1. `index`: in Postures::on_handle.
hand::Skeleton handle_posture(const Postures& postures, std::size_t index, double effort);
hand::Skeleton pinch_posture(const Postures& postures, double effort);

// The index in Postures::on_handle of the most comfortable posture for a shoulder position (m): back of the
// hand up, forearm towards the shoulder.
std::size_t natural_handle_posture(const Postures& postures, const Pose& tool, const Vec3& up,
                                   const Vec3& shoulder);

// The frame for fingers at a tool: the position and z axis of the tool, x towards the shoulder, then rotated
// about z by `twisted` rad.
Pose frame_towards(const Pose& tool, const Vec3& shoulder, double twisted);

// Closes the fingers on the wrench as far as contact allows, and on a nut of width `nut_width` (m across
// flats). `wrench` null: a fixed closure. `grip_distance`: m from the jaw's centre along the handle.
Postures make_postures(const collision::ToolShape* wrench, double grip_distance,
                       hand::Side side = hand::Side::right, double nut_width = 0.024);

// The postures at each tool of the setup.
std::vector<Postures> postures_of_tools(const servo::Setup& setup, const servo::State& state,
                                        hand::Side side = hand::Side::right);

// Interpolates positions linearly and rotations spherically; share 0 … 1 from a to b.
hand::Skeleton interpolate(const hand::Skeleton& a, const hand::Skeleton& b, double share);

}  // namespace bolt::scene
