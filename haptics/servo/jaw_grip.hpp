// The wrench on a nut where contact says how it sits: what is held follows from geometry alone (contact/
// jaw.hpp), and how much it bears from the corners (joint/corner.hpp).
//
// The hexagon turns with the jaw wherever that goes beyond its play, as far as contacts are concerned, and
// contacts have no lever about the bolt: about its axis the joint law is all that is felt, with its implicit
// step, and in the other five directions contacts are. The other choice, contacts that drive the nut, would
// feel the law through the god-object's tolerance: a hundredth of a millimetre at a corner is 3 N·m of 100.
// Nothing jumps where the nut begins to be held: the jaw is then within its play, law and lever are nothing.
#pragma once

#include <span>

#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

// The wrench's frame to the nut's.
Pose on_nut(const NutPlace& nut, double nut_angle, const ToolPose& tool);

contact::HexagonPrism prism_of(const NutPlace& nut);

// Takes hold where the jaw is around a hexagon that lies between its flats, by more than its bevel, and lets
// go where it is not around it any more. `lost`: m of the flats that are rounded off, by joint.
void update_jaw_grip(const Setup& setup, std::span<const joint::JointState> joints,
                     std::span<const double> lost, const ToolPose& tool, Engagement& engagement);

// The handle that a held wrench is for its nut.
joint::Handle jaw_handle(const Setup& setup, const NutPlace& nut, double lost, const Engagement& engagement);

// After the nut's step: a jaw that is turned on beyond what the corners bear rounds them by the work that
// this takes, bears less the further it goes, and at last lets go. True in the tick in which it does.
bool round_corners(const Setup& setup, const NutPlace& nut, const joint::JointState& joint, double& lost,
                   Engagement& engagement);

}  // namespace bolt::servo
