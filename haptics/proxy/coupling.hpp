// The virtual coupling: a spring and damper between the device and the tool that contacts hold back (Colgate,
// Stanley and Brown, IROS 1995). What it renders is all that is felt of a contact.
#pragma once

#include "engine/base/math.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::proxy {

struct Coupling {
    double stiffness = 1000.0;     // N/m
    double torsion = 10.0;         // N·m/rad
    double damping = 0.0;          // N·s/m
    double torsion_damping = 0.0;  // N·m·s/rad
    // N and N·m that are approached and never exceeded. 0: none is rendered.
    double force = 20.0;
    double torque = 2.0;
};

// What a device, with a hand on it, can take.
struct CouplingRange {
    double force = 20.0;            // N
    double torque = 2.0;            // N·m; 0: renders none
    double stiffness = 3000.0;      // N/m, the stiffest wall it may render
    double torsion = 30.0;          // N·m/rad
    double damping = 2.0;           // N·s/m, its own and the hand's
    double torsion_damping = 0.02;  // N·m·s/rad
    double dt = 0.001;              // s
};

// As stiff as passivity allows, b > K dt / 2 + |B| (Colgate and Schenkel, J. Robotic Systems 14(1), 1997),
// with a margin; no stiffer than that a collision at 0.5 m/s adds at most a tenth of the greatest force in a
// millisecond; damped with half of what is left. Its springs weigh a tool's motions against each other also
// where a device renders no force or torque, so they are never 0 for that.
Coupling make_coupling(const CouplingRange& range);

// Tool against device.
struct Offset {
    Vec3 linear{0.0};   // m
    Vec3 angular{0.0};  // axis times the sine of the angle: no leap anywhere, half a turn pulls neither way
};

Offset offset_between(const Pose& device, const Pose& tool);

// At the device's origin, on the device. `before`: the offset of the last tick.
force::OutputCommand coupling_force(const Coupling& coupling, const Offset& offset, const Offset& before,
                                    double dt);

// J that the springs hold and may give back, for the passivity observer. A lower bound: exact while they are
// linear, less by what saturation rounds off.
double stored_energy(const Coupling& coupling, const Offset& offset);

}  // namespace bolt::proxy
