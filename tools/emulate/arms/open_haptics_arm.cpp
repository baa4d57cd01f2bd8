#include "tools/emulate/arms/open_haptics_arm.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::emulate {

namespace {

constexpr double encoder_step = 55e-6;                      // m
constexpr double uncalibrated_offset = 20e-3;               // m
constexpr HdVector max_gimbal_torque{0.188, 0.188, 0.048};  // N·m

HdMatrix product(const HdMatrix& a, const HdMatrix& b) {
    HdMatrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

HdMatrix transposed(const HdMatrix& a) {
    HdMatrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = a[j][i];
    return out;
}

HdMatrix turn_about(std::size_t axis, double angle) {
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    HdMatrix out{};
    out[axis][axis] = 1.0;
    out[next][next] = out[last][last] = std::cos(angle);
    out[next][last] = -std::sin(angle);
    out[last][next] = std::sin(angle);
    return out;
}

// From a neutral gimbal: the tip to the right, the tip down and clockwise are positive.
HdMatrix orientation_at(const HdArm& arm, const HdVector& gimbal) {
    return product(arm.forearm, product(turn_about(1, -gimbal[0]),
                                        product(turn_about(0, -gimbal[1]), turn_about(2, -gimbal[2]))));
}

// The direction about which motor `i` turns the stylus, from the difference of two orientations.
HdVector motor_axis(const HdArm& arm, std::size_t i) {
    constexpr double h = 1e-5;
    HdVector more = arm.gimbal, less = arm.gimbal;
    more[i] += h;
    less[i] -= h;
    const HdMatrix turned = product(orientation_at(arm, more), transposed(orientation_at(arm, less)));
    return {(turned[2][1] - turned[1][2]) / (4 * h), (turned[0][2] - turned[2][0]) / (4 * h),
            (turned[1][0] - turned[0][1]) / (4 * h)};
}

double determinant(const HdMatrix& m) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        sum += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
    }
    return sum;
}

}  // namespace

double length(const HdVector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

HdMatrix orientation(const HdArm& arm) { return orientation_at(arm, arm.gimbal); }

void step(HdArm& arm, bool powered) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double spring = arm.hand.stiffness * (arm.intention[i] - arm.position[i]);
        const double motor = powered ? arm.force[i] : 0.0;
        const double inverse_mass = hd_time_step / arm.hand.mass;
        // Implicit in the damping.
        const double free =
            (arm.velocity[i] + inverse_mass * (spring + motor)) / (1.0 + inverse_mass * arm.hand.damping);
        arm.velocity[i] =
            std::copysign(std::max(std::abs(free) - inverse_mass * arm.hand.friction, 0.0), free);
        arm.position[i] += hd_time_step * arm.velocity[i];
    }
    arm.time += hd_time_step;
}

HdVector torque_on_hand(const HdArm& arm) {
    const HdMatrix axes{motor_axis(arm, 0), motor_axis(arm, 1), motor_axis(arm, 2)};
    HdVector torque{};
    for (std::size_t i = 0; i < 3; ++i) {  // Cramer's rule
        HdMatrix replaced = axes;
        for (std::size_t row = 0; row < 3; ++row) replaced[row][i] = arm.gimbal_torque[row];
        torque[i] = determinant(replaced) / determinant(axes);
    }
    return torque;
}

HdVector measured_position(const HdArm& arm, bool calibrated) {
    HdVector out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = encoder_step * std::round(arm.position[i] / encoder_step) +
                 (calibrated ? 0.0 : uncalibrated_offset);
    return out;
}

bool saturate(const HdArm& arm, HdVector& force, HdVector& gimbal_torque) {
    const double most = std::min(arm.report.force, 1e3);
    const double magnitude = length(force);
    bool any = magnitude > most * (1.0 + 1e-9);
    if (any)
        for (double& c : force) c *= most / magnitude;
    for (std::size_t i = 0; i < 3; ++i) {
        any |= std::abs(gimbal_torque[i]) > max_gimbal_torque[i] * (1.0 + 1e-9);
        gimbal_torque[i] = std::clamp(gimbal_torque[i], -max_gimbal_torque[i], max_gimbal_torque[i]);
    }
    return any;
}

}  // namespace bolt::emulate
