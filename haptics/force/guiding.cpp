#include "haptics/force/guiding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace bolt::force {

namespace {

// Distances at which the spring ends and the hyperbola k/d begins; between them the force is capped.
struct Ranges {
    double spring = 0.0, hyperbola = 0.0;  // m
};

Ranges ranges_of(const GuidingParameters& g) {
    const double d_min = std::sqrt(g.gain / g.stiffness);
    if (g.stiffness * d_min <= g.greatest) return {d_min, d_min};
    return {g.greatest / g.stiffness, g.gain / g.greatest};
}

std::complex<double> projected(const Hexagon& hexagon, const Vec3& jaw) {
    return {glm::dot(jaw, hexagon.flat), glm::dot(jaw, hexagon.across)};
}

std::complex<double> fifth_power(std::complex<double> z) { return z * (z * z) * (z * z); }

}  // namespace

double guiding_pull(const GuidingParameters& g, double distance) {
    const Ranges r = ranges_of(g);
    if (distance <= r.spring) return g.stiffness * distance;
    if (distance <= r.hyperbola) return g.greatest;
    return std::clamp(2.0 - distance / g.reach, 0.0, 1.0) * g.gain / distance;
}

Vec3 guiding_force(const GuidingParameters& guiding, const Vec3& tool, const Vec3& target) {
    const Vec3 away = target - tool;
    const double d = glm::length(away);
    return d > 0.0 ? away * (guiding_pull(guiding, d) / d) : Vec3(0.0);
}

double guiding_potential(const GuidingParameters& g, double distance) {
    const Ranges r = ranges_of(g);
    if (distance <= r.spring) return 0.5 * g.stiffness * square(distance);
    double potential = 0.5 * g.stiffness * square(r.spring);
    potential += g.greatest * (std::min(distance, r.hyperbola) - r.spring);
    if (distance <= r.hyperbola) return potential;
    potential += g.gain * std::log(std::min(distance, g.reach) / r.hyperbola);
    // Beyond the reach: the integral of (2 − d/reach) k/d.
    const double outer = std::min(distance, 2.0 * g.reach);
    if (outer > g.reach) potential += g.gain * (2.0 * std::log(outer / g.reach) - (outer / g.reach - 1.0));
    return potential;
}

Vec3 aligning_torque(double greatest, const Hexagon& h, const Vec3& jaw, const Vec3& normal) {
    // A rotation δ moves the jaw by δ × jaw and changes Re z⁶ by 6 Re(z⁵ δz).
    const std::complex<double> z5 = fifth_power(projected(h, jaw));
    const Vec3 about = z5.real() * glm::cross(jaw, h.flat) - z5.imag() * glm::cross(jaw, h.across);
    const Vec3 square_on = 2.0 * glm::dot(normal, h.axis) * glm::cross(normal, h.axis);
    return greatest * (about + square_on);
}

double aligning_potential(double greatest, const Hexagon& h, const Vec3& jaw, const Vec3& normal) {
    const std::complex<double> z = projected(h, jaw);
    return greatest * ((1.0 - (fifth_power(z) * z).real()) / 6.0 + 1.0 - square(glm::dot(normal, h.axis)));
}

}  // namespace bolt::force
