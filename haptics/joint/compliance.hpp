// Elastic compliance of bolt and clamped members, VDI 2230-1 sections 5.1.1 and 5.1.2. m/N.
#pragma once

#include <span>

#include "haptics/joint/design.hpp"

namespace bolt::joint {

// δ_S: head (0.5 d), shank, free thread, engaged thread (0.5 d on the core) and nut (0.4 d).
double bolt_compliance(const Thread& thread, double E, double grip, double shank);

// δ_P of a stack of layers under the deformation cones of head and nut (through-bolted joint), concentric,
// with a cone that may be cut by the outer diameter D_A (0: unlimited; the cone's angle is then taken at D_A
// = 3 d_w). Layers of different modulus are integrated exactly along the cone.
double member_compliance(std::span<const Member> layers, double bearing_diameter, double hole, double D_A);

// Both, of a design: shank length from the bolt's thread length, washers as steel layers.
double joint_compliance(const JointDesign& design);

}  // namespace bolt::joint
