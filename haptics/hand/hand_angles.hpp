// Converts glove readings to the joint angles of the hand.
#pragma once

#include "haptics/hand/angles.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_handshake.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {

// Angle of each sensor's joint, rad, signs as in glove_calibration.hpp. A DIJ without a sensor follows its
// PIJ; other joints without a calibrated sensor are 0, for example the wrist after a calibration by postures.
PerSensor<double> sensor_angles(const Calibration& calibration, const GloveFrame& frame);

// Ratio of DIP to PIP flexion (H. Rijpkema, M. Girard, Computer animation of knowledge-based human grasping,
// SIGGRAPH 1991).
inline constexpr double dij_of_pij = 2.0 / 3.0;

// Abduction sensors measure the angle between neighbouring fingers. They are summed outward from the middle
// finger, whose own abduction is not measured and is taken as 0.
hand::Angles hand_angles(const PerSensor<double>& angles);

}  // namespace bolt::hand
