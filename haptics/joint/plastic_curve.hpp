// How the threaded part of a bolt yields: load capacity over plastic elongation, from the elastic limit over
// R_p0.2 to R_m at uniform elongation, then necking, then nothing.
//
//   Y(u) = L_e + (L_m − L_e) (1 − e^{−(u/u_c)^¾}) / (1 − e^{−(u_u/u_c)^¾})    up to u_u
//
// Voce hardening with a power below one, so that the slope is infinite at u = 0: the torque curve bends into
// yield without a kink. The shape u_c is set so that the load at 0.2 % plastic strain is R_p0.2 A_s. The form
// is ours; it is pinned to the three strengths that ISO 898-1 gives and to half the elongation after fracture
// as uniform elongation.
#pragma once

#include "haptics/joint/fastener.hpp"
#include "haptics/joint/thread.hpp"

namespace bolt::joint {

struct PlasticCurve {
    double elastic_load = 0.0;   // L_e, N of equivalent stress × A_s
    double ultimate_load = 0.0;  // L_m
    double scale = 0.0;          // u_c, m
    double uniform = 0.0;        // u_u, m
    double spread = 0.0;         // 1 / (1 − e^{−(u_u/u_c)^¾})
    double fracture = 0.0;       // u_f > u_u, m
    double neck_load = 0.0;      // at u_f, just before it breaks

    // `length`: plastic length (free thread and half the engaged thread), m. `compliance` of the joint bounds
    // the slope of necking so that a turned nut never lets the load snap through (the joint stays a function
    // of angle).
    static PlasticCurve make(const Thread& thread, const PropertyClass& bolt, double length,
                             double compliance);

    struct Point {
        double load = 0.0;   // Y(u), N
        double slope = 0.0;  // dY/du, N/m; +∞ at u = 0
    };
    [[nodiscard]] Point at(double elongation) const;
    [[nodiscard]] double load(double elongation) const { return at(elongation).load; }
    [[nodiscard]] double slope(double elongation) const { return at(elongation).slope; }
};

}  // namespace bolt::joint
