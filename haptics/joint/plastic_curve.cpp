#include "haptics/joint/plastic_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::joint {

namespace {

double power(double x) { return std::sqrt(x * std::sqrt(x)); }  // x^¾

double rise(double u, double scale) { return -std::expm1(-power(u / scale)); }

// u_c with rise(u_p)/rise(u_u) = share. The ratio falls monotonically as u_c grows, from 1 to (u_p/u_u)^¾.
double fit_scale(double u_p, double u_u, double share) {
    double low = std::log(u_u * 1e-6), high = std::log(u_u * 1e6);
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        const double scale = std::exp(middle);
        (rise(u_p, scale) / rise(u_u, scale) > share ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

}  // namespace

PlasticCurve PlasticCurve::make(const Thread& thread, const PropertyClass& bolt, double length,
                                double compliance) {
    PlasticCurve c;
    c.elastic_load = bolt.proof_ratio * bolt.R_p02 * thread.A_s;
    c.ultimate_load = bolt.R_m * thread.A_s;
    c.uniform = 0.5 * bolt.fracture_strain * length;
    const double u_p = 0.002 * length;
    const double share = (bolt.R_p02 * thread.A_s - c.elastic_load) / (c.ultimate_load - c.elastic_load);
    c.scale = fit_scale(u_p, c.uniform, share);
    c.spread = 1.0 / rise(c.uniform, c.scale);
    c.neck_load = 0.8 * c.ultimate_load;
    const double drop = c.ultimate_load - c.neck_load;
    c.fracture = c.uniform + std::max(0.5 * bolt.fracture_strain * length, 2.0 * drop * compliance);
    return c;
}

PlasticCurve::Point PlasticCurve::at(double u) const {
    if (u <= 0.0) return {elastic_load, std::numeric_limits<double>::infinity()};
    if (u < uniform) {
        const double x = power(u / scale);
        const double risen = -std::expm1(-x);
        const double span = (ultimate_load - elastic_load) * spread;
        return {elastic_load + span * risen, span * (1.0 - risen) * 0.75 * x / u};
    }
    if (u >= fracture) return {0.0, 0.0};
    const double slope = -(ultimate_load - neck_load) / (fracture - uniform);
    return {ultimate_load + slope * (u - uniform), slope};
}

}  // namespace bolt::joint
