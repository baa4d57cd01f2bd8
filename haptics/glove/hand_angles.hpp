// From what a glove gives to how the hand in it is bent.
#pragma once

#include "haptics/glove/calibration.hpp"
#include "haptics/glove/greeting.hpp"
#include "haptics/hand/angles.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::glove {

// Of every sensor, rad, signs as calibration.hpp has them. A DIJ that is not measured follows its PIJ; any
// other joint that is not is 0: the wrist's, as long as only postures were calibrated.
BySensor<double> sensor_angles(const Calibration& calibration, const Frame& frame);

// What the last joint of a finger bends of what the one before it does (H. Rijpkema, M. Girard, Computer
// animation of knowledge-based human grasping, SIGGRAPH 1991).
inline constexpr double dij_of_pij = 2.0 / 3.0;

// Abduction sensors lie between fingers: summed outward from the middle finger, which the glove does not
// measure and which is taken not to go to a side.
hand::Angles hand_angles(const BySensor<double>& angles);

constexpr hand::Side side_of(Hand hand) { return hand == Hand::left ? hand::Side::left : hand::Side::right; }

}  // namespace bolt::glove
