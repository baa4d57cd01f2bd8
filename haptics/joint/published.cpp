#include "haptics/joint/published.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::joint {

namespace {

constexpr double published_gravity = 9.8;  // m/s², the paper's value
constexpr double Nmm = 1e-3;

double sign_of(Direction direction) { return direction == Direction::tighten ? 1.0 : -1.0; }

double weight(const PublishedParameters& p) { return p.nut_mass_g * 1e-3 * published_gravity; }

// F_c = A E* h'/κ in newtons; A·h' in mm², E in GPa makes kN.
double contact_force(const PublishedParameters& p, double area_slope_mm2) {
    const double compliance = (1.0 - square(p.nu1)) / p.E1_GPa + (1.0 - square(p.nu2)) / p.E2_GPa;
    return area_slope_mm2 / compliance / p.kappa * 1e3;
}

// Always inlined, so that two calls in one function compute their common cosine once.
[[gnu::always_inline]] inline double lever(const PublishedParameters& p, Direction direction) {
    const double lead = p.pitch_mm / (2.0 * pi);
    return (sign_of(direction) * lead + p.mu2 * p.r_t_mm / (2.0 * std::cos(p.beta)) + p.mu1 * p.r_b_mm) *
           1e-3;
}

[[gnu::always_inline]] inline double degrees_per_newton(const PublishedParameters& p) {
    double sum = 0.0;
    for (const double k : p.spring_rates_1e6) sum += 1.0 / (k * 1e6);
    return to_degrees(2.0 * pi / p.pitch_mm * sum);
}

double linear_width_deg(const PublishedParameters& p) {
    const double yield_start = published_yield_torque(p, p.theta_max_deg - p.yield_width_deg);
    return yield_start / published_linear_slope(p);
}

}  // namespace

double published_navigation_torque(const PublishedParameters& p, Direction direction) {
    return -weight(p) * (std::sin(p.alpha) - sign_of(direction) * p.mu * std::cos(p.alpha)) * 0.5 * p.d2_mm *
           Nmm;
}

double published_thread_torque(const PublishedParameters& p, double area_slope_mm2, Direction direction) {
    const double load = weight(p) - sign_of(direction) * contact_force(p, area_slope_mm2);
    return -load * (std::sin(p.alpha) + p.mu2 * std::cos(p.alpha)) * p.d2_mm * Nmm;
}

double published_bearing_torque(const PublishedParameters& p, double area_slope_mm2, Direction direction) {
    const double load = contact_force(p, area_slope_mm2) - sign_of(direction) * weight(p);
    const double pressure = load / (0.25 * pi * (square(p.D1_mm) - square(p.D2_mm)));
    const double integral = (p.D1_mm * square(p.D1_mm) - p.D2_mm * square(p.D2_mm)) / 3.0;
    return -pi * pressure * p.mu1 * integral * Nmm;
}

double published_lever(const PublishedParameters& p, Direction direction) { return lever(p, direction); }

double published_degrees_per_newton(const PublishedParameters& p) { return degrees_per_newton(p); }

double published_linear_slope(const PublishedParameters& p) {
    return published_lever(p, Direction::tighten) / published_degrees_per_newton(p);
}

double published_yield_torque(const PublishedParameters& p, double theta_deg) {
    return p.T_max_Nm - p.kappa1 * square(std::min(theta_deg - p.theta_max_deg, 0.0));
}

double published_angle(const PublishedParameters& p, double torque) {
    const double yield = p.theta_max_deg - p.yield_width_deg;
    const double slope = published_linear_slope(p), yield_torque = published_yield_torque(p, yield);
    if (torque < yield_torque) return yield - (yield_torque - std::max(torque, 0.0)) / slope;
    return p.theta_max_deg - std::sqrt(std::max(p.T_max_Nm - torque, 0.0) / p.kappa1);
}

PublishedBoundaries published_boundaries(const PublishedParameters& p) {
    PublishedBoundaries b{};
    b.yield = p.theta_max_deg - p.yield_width_deg;
    b.linearity = b.yield - linear_width_deg(p);
    b.transition = b.linearity - p.transition_width_deg;
    return b;
}

PublishedResponse evaluate_published(const PublishedParameters& p, const PublishedBoundaries& b,
                                     const PublishedState& s, double theta_deg, Direction direction) {
    const bool virgin = theta_deg >= s.peak_deg;
    // Below the furthest angle the joint follows the elastic line, shifted by the permanent set.
    const double theta = virgin ? theta_deg : theta_deg - s.set_deg;
    PublishedResponse reading;

    if (virgin && theta >= b.yield) {
        reading.stage = Stage::yield;
        const double torque = published_yield_torque(p, theta);
        reading.clamp = torque / lever(p, Direction::tighten);
        reading.torque = direction == Direction::tighten ? torque : -reading.clamp * lever(p, direction);
        return reading;
    }
    if (theta >= b.linearity) {
        reading.stage = Stage::linearity;
        reading.clamp = (theta - b.linearity) / degrees_per_newton(p);
        reading.torque = sign_of(direction) * reading.clamp * lever(p, direction);
        return reading;
    }
    if (theta >= b.transition) {
        reading.stage = Stage::transition;
        const double share = (theta - b.transition) / p.transition_width_deg;
        const double area_slope = p.contact_end_mm2 * square(share);
        reading.clamp = contact_force(p, area_slope);
        reading.torque = published_thread_torque(p, area_slope, direction) +
                         published_bearing_torque(p, area_slope, direction);
        return reading;
    }
    reading.torque = published_navigation_torque(p, direction);
    return reading;
}

void published_advance(const PublishedParameters& p, const PublishedBoundaries& b, PublishedState& s,
                       double theta_deg) {
    if (theta_deg <= std::max(s.peak_deg, b.yield)) return;
    s.peak_deg = theta_deg;
    const double clamp = published_yield_torque(p, theta_deg) / lever(p, Direction::tighten);
    s.set_deg = theta_deg - (b.linearity + clamp * degrees_per_newton(p));
}

}  // namespace bolt::joint
