// Grip of a wrench on a nut with contact simulation. Geometry alone determines whether the jaw holds the nut
// (haptics/collision/jaw.hpp); the corners limit the torque that it can transmit (haptics/joint/corner.hpp).
//
// For contacts the hexagon turns with the jaw beyond the play, and the contacts' moment about the bolt is
// removed. So the joint law with its implicit step acts about the bolt's axis, and contacts act in the other
// five directions. If contacts drove the nut instead, the law would pass through the god-object's tolerance,
// and 0.01 mm at a corner is 3 N·m of 100 N·m. The force is continuous at engagement: inside the play both
// the law's torque and the removed moment are zero.
#pragma once

#include <span>

#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

// Pose of the wrench in the nut's frame.
Pose on_nut(const NutGeometry& nut, double nut_angle, const ToolPose& tool);

collision::HexagonPrism prism_of(const NutGeometry& nut);

// One tick. Engages a nut if the jaw surrounds its hexagon by more than the jaw's bevel and is aligned within
// the play; releases it if the jaw no longer surrounds it. `lost`, by joint: m of each flat that is rounded
// off.
void update_jaw_grip(const Setup& setup, std::span<const joint::JointState> joints,
                     std::span<const double> lost, const ToolPose& tool, Engagement& engagement);

// The engaged wrench as the joint law's handle. `lost` in m.
joint::Handle jaw_handle(const Setup& setup, const NutGeometry& nut, double lost,
                         const Engagement& engagement);

// Call after the joint's step. A jaw that turns beyond the corners' torque removes material in proportion to
// the work, and transmits less torque the further it turns. Returns true in the tick in which it slips off
// the nut.
bool round_corners(const Setup& setup, const NutGeometry& nut, const joint::JointState& joint, double& lost,
                   Engagement& engagement);

}  // namespace bolt::servo
