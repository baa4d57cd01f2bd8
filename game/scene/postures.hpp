// How hard the hand that is shown works, where no device lets it be felt. Only of what a tick put out: the
// same session shows the same hand.
#pragma once

#include <array>

#include "game/world/world.hpp"
#include "haptics/hand/finger_closure.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::scene {

struct Strain {
    double share = 0.0;   // 0 at rest … 1: the most that this hand can
    double tremor = 0.0;  // −1 … 1, of the muscles: what changes in the torque faster than a hand follows
    double quick = 0.0;   // the same share, less smooth, with the torque's sign
    double slow = 0.0;
};

// What the wrench bears at most is what its spring gives at 2.5 degrees (hud.cpp), fingers slip before
// that. −1 … 1, tightening positive; 0 with nothing in the hand.
using EffortAccess = ecs::Access<const world::Joint, const world::ToolContact, const world::Hand>;
double effort(const servo::Setup& setup, const EffortAccess& world);

// A tick.
void strain(Strain& strain, const servo::Setup& setup, const EffortAccess& world);

// How a hand is bent about what it holds, when nobody wears a glove: around the wrench's handle, with thumb
// and index finger on a nut, or open.

// The 26 joints in the frame of the tool (servo::DeviceSample). A handle can be held four ways: palm on the
// one face or the other, thumb towards the jaw or away from it.
struct Postures {
    std::array<hand::Skeleton, 4> on_handle;
    hand::Skeleton on_nut, open;
    // The same without any force, and with all that a hand has: fingers that only lie on the handle, and a
    // wrist rolled over it with the fingers after; fingertips bent back on the nut.
    std::array<hand::Skeleton, 4> at_ease, strained;
    hand::Skeleton on_nut_strained;
    double grip_at = 0.0;  // m, from the jaw's middle along the handle
};

// On the handle held that way, with so much of the force that there is (0 … 1); likewise on a nut.
hand::Skeleton holding(const Postures& postures, std::size_t way, double strain);
hand::Skeleton pinching(const Postures& postures, double strain);

// The way that suits somebody whose shoulder is there, with the tool so: back of the hand up, forearm towards
// the shoulder.
std::size_t natural_grip(const Postures& postures, const Pose& tool, const Vec3& up, const Vec3& shoulder);

// A tool's frame for fingers on a nut: they come from the shoulder's side, however far they have twisted it.
Pose towards(const Pose& tool, const Vec3& shoulder, double twisted);

// `grip_at`: m from the jaw's middle along the handle. The fingers close on the wrench as far as it lets
// them, and on a nut that is `nut_width` (m) across flats.
Postures make_postures(const collision::ToolShape* wrench, double grip_at,
                       hand::Side side = hand::Side::right, double nut_width = 0.024);

// Between two of them.
hand::Skeleton between(const hand::Skeleton& a, const hand::Skeleton& b, double share);

}  // namespace bolt::scene
