// Scripted collisions: a wrench moves at constant speed along straight legs into obstacles and over them.
#pragma once

#include <string>
#include <vector>

#include "tests/proxy/scene.hpp"

namespace bolt::test {

struct Script {
    std::string name;
    Scene scene;
    std::vector<Vec3> way;  // m, corners of the device's path
    Vec3 turn{0.0};         // rad, constant rotation of the wrench
};

std::vector<Script> collisions();

// Poses of the device at each tick of dt (s), the ends of the legs included.
std::vector<Pose> device_poses(const Script& script, double speed, double dt);

// Device position (m) and output on the hand in one tick.
struct Felt {
    Vec3 device{0.0};
    force::OutputCommand command;
};
using Run = std::vector<Felt>;

Run with_god_object(const GodObjectParameters& parameters, const Script& script, double speed, double dt);

// For comparison, penalty forces at the device's own pose: a spring of the coupling's stiffness at every
// penetrating point, or, which is smoother, only at the deepest point in each obstacle. The sum saturates
// like the coupling's force.
enum class Penalty { every_point, deepest };
Run with_penalty(const proxy::Coupling& coupling, const Script& script, double speed, double dt,
                 Penalty which);

struct Shock {
    double step = 0.0;  // greatest change of force in 1 ms, as a share of the greatest force
    double torque_step = 0.0;
    // Greatest change of force in 1 ms that the hand's own motion through the spring does not explain, as a
    // share of the force before it. Forces below a tenth of the greatest force are excluded.
    double event = 0.0;
};
Shock shock_of(const Run& run, const proxy::Coupling& coupling, double dt);

}  // namespace bolt::test
