// The virtual coupling: a spring and damper between the commanded and the constrained pose of the tool
// (Colgate, Stanley and Brown, IROS 1995). The hand feels contacts only through it.
#pragma once

#include "engine/base/math.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::proxy {

struct Coupling {
    double stiffness = 1000.0;     // N/m
    double torsion = 10.0;         // N·m/rad, torsional stiffness
    double damping = 0.0;          // N·s/m
    double torsion_damping = 0.0;  // N·m·s/rad
    // N and N·m at which the output saturates smoothly. 0: none is rendered.
    double max_force = 20.0;
    double max_torque = 2.0;
};

// Capability of a device with a hand on it.
struct CouplingRange {
    double max_force = 20.0;        // N
    double max_torque = 2.0;        // N·m; 0: renders none
    double stiffness = 3000.0;      // N/m, greatest stiffness that it may render
    double torsion = 30.0;          // N·m/rad, greatest torsional stiffness
    double damping = 2.0;           // N·s/m, of device and hand together
    double torsion_damping = 0.02;  // N·m·s/rad
    double dt = 0.001;              // s
};

// The coupling is as stiff as passivity permits with a margin: the damping of device and hand must exceed
// stiffness × dt / 2 plus the coupling's own damping (Colgate and Schenkel, J. Robotic Systems 14(1), 1997).
// Stiffness and damping are also small enough that a collision at 0.5 m/s raises the force by at most a tenth
// of the maximum per millisecond. The damper of the coupling gets half of the damping that the stiffness
// leaves. The stiffnesses are positive even if the device renders no force or torque, because they also
// weight the tool's motions.
Coupling make_coupling(const CouplingRange& range);

// The constrained pose of the tool relative to the commanded pose.
struct Offset {
    Vec3 linear{0.0};   // m
    Vec3 angular{0.0};  // axis times the sine of the angle, which is continuous; it vanishes at half a turn
};

Offset offset_between(const Pose& commanded_tool, const Pose& constrained_tool);

// The force and torque on the hand, at the tool's origin. `before`: the offset of the last tick. `dt` in s.
force::OutputCommand coupling_force(const Coupling& coupling, const Offset& offset, const Offset& before,
                                    double dt);

// J stored in the springs, for the passivity observer. A lower bound: nearly exact for small offsets, too
// small where the force saturates.
double stored_energy(const Coupling& coupling, const Offset& offset);

}  // namespace bolt::proxy
