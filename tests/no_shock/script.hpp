// Collisions by script: a wrench is led along straight ways at a constant speed into obstacles and over them.
#pragma once

#include <string>
#include <vector>

#include "tests/proxy/scene.hpp"

namespace bolt::test {

struct Script {
    std::string name;
    Scene scene;
    std::vector<Vec3> way;  // m, of the device
    Vec3 turn{0.0};         // rad, of the wrench all along
};

std::vector<Script> collisions();

// The device at each tick of dt, the ends of the straight ways among them.
std::vector<Pose> device_poses(const Script& script, double speed, double dt);

// What the hand is given in a run, a line a tick.
struct Felt {
    Vec3 device{0.0};
    force::OutputCommand command;
};
using Run = std::vector<Felt>;

Run with_god_object(const GodObjectParameters& parameters, const Script& script, double speed, double dt);

// For comparison, forces at the device's own pose: a spring of the coupling's stiffness at every point that
// is inside, or, kinder, only at the deepest point in each obstacle. The sum is bounded as the coupling's is.
enum class Penalty { every_point, deepest };
Run with_penalty(const proxy::Coupling& coupling, const Script& script, double speed, double dt,
                 Penalty which);

struct Shock {
    double step = 0.0;  // greatest change of force in a millisecond, of the greatest force
    double torque_step = 0.0;
    double event = 0.0;  // greatest change beyond what the hand's own motion makes of a spring, of the force
                         // felt, while more than a tenth of the greatest force is felt
};
Shock shock_of(const Run& run, const proxy::Coupling& coupling, double dt);

}  // namespace bolt::test
