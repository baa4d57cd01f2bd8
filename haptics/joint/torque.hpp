// Torque and clamp force of a metric thread: Motosh's three parts, and VDI 2230's closed forms.
#pragma once

#include "haptics/joint/fastener.hpp"
#include "haptics/joint/thread.hpp"

namespace bolt::joint {

// The lever arms of T = F (P/2π + μ_G r_t/cos β + μ_K r_b), m. Motosh, J. Eng. Ind. 98 (1976) 849.
struct TorqueLevers {
    double lead = 0.0;     // P/2π: what stretches the bolt
    double thread = 0.0;   // μ_G (d2/2) / cos β
    double bearing = 0.0;  // μ_K r_b, r_b effective bearing radius

    [[nodiscard]] double friction() const { return thread + bearing; }
    [[nodiscard]] double tighten() const { return lead + friction(); }
    [[nodiscard]] double loosen() const { return -lead + friction(); }  // torque against the nut's motion
};

TorqueLevers torque_levers(const Thread& thread, double mu_thread, double mu_bearing,
                           double bearing_mean_diameter);

// D_Km = (d_w + d_h)/2, VDI 2230: mean diameter of the bearing under the turned nut or head.
inline double bearing_mean_diameter(double d_w, double d_h) { return 0.5 * (d_w + d_h); }

// tan(φ + ρ'), the slope on which the nut slides: φ lead angle, tan ρ' = share · μ_G/cos β. share in [−1, 1]:
// +1 tightening, −1 loosening. VDI 2230's closed forms write it as P/(π d2) + 1.155 μ_G, the first order of
// this; the published table A1 is reproduced to its rounding by the exact tangent (within 0.9 % by the closed
// form).
double sliding_slope(const Thread& thread, double mu_thread, double share = 1.0);

// Ratio of equivalent (von Mises) to tensile stress while the thread torque acts: √(1 + 3 [κ (d2/d0) tan(φ +
// ρ')]²).
double equivalent_stress_ratio(const Thread& thread, double mu_thread, double kappa, double share = 1.0);

struct AssemblyPreload {
    double force = 0.0;   // F_M, N
    double torque = 0.0;  // M_A, N·m
};

// VDI 2230 table A1: preload at which the equivalent stress is `utilisation` of R_p0.2, and its torque
// M_A = F_M (d2/2 tan(φ + ρ') + D_Km/2 μ_K).
AssemblyPreload assembly_preload(const Thread& thread, const PropertyClass& bolt, double mu_thread,
                                 double mu_bearing, double bearing_mean_diameter, double utilisation = 0.9);

}  // namespace bolt::joint
