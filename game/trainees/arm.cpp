#include "game/trainees/arm.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::trainees {

namespace {

constexpr double fading = 0.1;  // s

// One implicit step of m v' + b v + k x = F; the spring gives `most` at most.
void swing(Vec3& x, Vec3& v, const Vec3& force, double m, double b, double k, double most, double dt) {
    const double far = glm::length(x);
    if (k * far > most) k = most / far;
    v = (v + (dt / m) * (force - k * x)) / (1.0 + dt * b / m + dt * dt * k / m);
    x += dt * v;
}

}  // namespace

void take_up(Arm& arm, const Pose& pose, const Pose& meant) {
    arm = {};
    arm.offset = pose.position - meant.position;
    arm.turn = rotation_vector(glm::normalize(pose.orientation * glm::conjugate(meant.orientation)));
}

Pose follow(const Impedance& i, Arm& arm, const Pose& meant, const force::OutputCommand& felt, bool grips,
            double dt) {
    if (grips) {
        const double left = std::max(0.0, 1.0 - dt / fading);
        arm.offset *= left;
        arm.turn *= left;
        arm.velocity = arm.rate = Vec3(0.0);
    } else {
        swing(arm.offset, arm.velocity, felt.force, i.mass, i.damping, i.stiffness, i.force, dt);
        swing(arm.turn, arm.rate, felt.torque, i.inertia, i.angular_damping, i.angular_stiffness, i.torque,
              dt);
    }
    return {meant.position + arm.offset, glm::normalize(rotation(arm.turn) * meant.orientation)};
}

}  // namespace bolt::trainees
