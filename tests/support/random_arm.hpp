// Random arms for stability tests. The chosen ranges extend from a relaxed grip of two fingers to a tense
// arm; a light hand with little damping is the difficult case.
#pragma once

#include "engine/base/random.hpp"
#include "haptics/device/simulated_arm.hpp"

namespace bolt::test {

using device::Arm;
using device::ArmParameters;
using device::encoder_pose;
using device::step;

ArmParameters random_arm(Random& random);

}  // namespace bolt::test
