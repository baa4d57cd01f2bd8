#include "tests/support/simulated_arm.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::test {

namespace {

double logarithmic(Random& random, double low, double high) {
    return low * std::pow(high / low, random.uniform());
}

Vec3 quantised(const Vec3& v, double step) {
    if (step <= 0.0) return v;
    return {step * std::floor(v.x / step + 0.5), step * std::floor(v.y / step + 0.5),
            step * std::floor(v.z / step + 0.5)};
}

// Returns the velocity after time h under a force, implicit damping, and dry friction, which may stop but not
// reverse the motion.
Vec3 accelerated(const Vec3& v, const Vec3& force, double mass, double damping, double friction, double h) {
    const Vec3 free = (v + force * (h / mass)) / (1.0 + h * damping / mass);
    const double speed = glm::length(free), lost = h * friction / mass;
    return speed <= lost ? Vec3(0.0) : free * (1.0 - lost / speed);
}

}  // namespace

ArmParameters random_arm(Random& random) {
    ArmParameters p;
    p.mass = logarithmic(random, 0.08, 1.5);
    p.damping = logarithmic(random, 1.0, 25.0);
    p.stiffness = logarithmic(random, 40.0, 1000.0);
    p.inertia = logarithmic(random, 4e-4, 6e-3);
    p.angular_damping = logarithmic(random, 4e-3, 0.15);
    p.angular_stiffness = logarithmic(random, 0.3, 6.0);
    p.friction = random.uniform(0.0, 0.2);
    p.angular_friction = random.uniform(0.0, 2e-3);
    p.encoder = logarithmic(random, 2e-6, 30e-6);
    p.angular_encoder = logarithmic(random, 2e-5, 3e-4);
    return p;
}

Pose sample(const Arm& arm) {
    return {quantised(arm.pose.position, arm.parameters.encoder),
            rotation(quantised(rotation_vector(arm.pose.orientation), arm.parameters.angular_encoder))};
}

void step(Arm& arm, const force::OutputCommand& command, double dt) {
    const ArmParameters& p = arm.parameters;
    for (std::size_t i = arm.sent.size() - 1; i > 0; --i) arm.sent[i] = arm.sent[i - 1];
    arm.sent[0] = command;
    const force::OutputCommand& had = arm.sent[static_cast<std::size_t>(p.delay)];
    const int parts = static_cast<int>(std::lround(dt / 25e-6));
    const double h = dt / parts;
    for (int i = 0; i < parts; ++i) {
        const Vec3 pull = p.stiffness * (arm.intention.position - arm.pose.position);
        const Vec3 turn = p.angular_stiffness *
                          rotation_vector(arm.intention.orientation * glm::conjugate(arm.pose.orientation));
        arm.velocity = accelerated(arm.velocity, had.force + pull, p.mass, p.damping, p.friction, h);
        arm.angular_velocity = accelerated(arm.angular_velocity, had.torque + turn, p.inertia,
                                           p.angular_damping, p.angular_friction, h);
        arm.pose.position += h * arm.velocity;
        arm.pose.orientation = glm::normalize(rotation(h * arm.angular_velocity) * arm.pose.orientation);
        arm.energy_out +=
            h * (glm::dot(had.force, arm.velocity) + glm::dot(had.torque, arm.angular_velocity));
    }
}

}  // namespace bolt::test
