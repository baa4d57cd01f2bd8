// The four-stage law of "A staged haptic rendering approach for virtual assembly of bolted joints in
// mechanical assembly" (Int. J. Adv. Manuf. Technol., 2018), exactly as printed, with its Table 1 as
// defaults.
//
// The parameters keep the paper's units (g, mm, GPa, rad, degrees, N·m), because tests compare with its
// printed figures. The functions return N, N·m, m and degrees. Values that the paper does not give are chosen
// here and marked (ours).
#pragma once

#include "engine/base/math.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::joint {

struct PublishedParameters {
    double nut_mass_g = 33.3;
    // rad. The paper calls α the helix angle but gives it the value of β, the flank angle of the thread.
    double alpha = pi / 6, beta = pi / 6;
    // Friction coefficients: of the free thread (stage 1), of the bearing face, of the loaded thread.
    double mu = 0.3, mu1 = 0.4, mu2 = 0.3;
    double pitch_mm = 2.0;                  // P of the thread, which the paper calls ρ in eq. 3
    double d2_mm = 14.7;                    // pitch diameter of the thread
    double D1_mm = 24.0, D2_mm = 14.7;      // outer and inner diameter of the bearing face
    double r_t_mm = 14.7, r_b_mm = 24.0;    // lever arms of thread and bearing friction, as printed
    double E1_GPa = 117.0, E2_GPa = 117.0;  // Young's moduli of the two faces; printed "Pa"
    double nu1 = 0.25, nu2 = 0.25;          // their Poisson's ratios
    double kappa = 2.0;                     // κ of the contact force F_c in stage 2
    // 10⁶ N/mm, of the seven springs in series that the paper makes of bolt, nut and members.
    double spring_rates_1e6[7] = {1.47, 1.46, 1.51, 1.53, 1.40, 1.38, 1.42};
    double T_max_Nm = 72.126;  // torque at the end of the yield stage
    double kappa1 = 0.0015;    // κ1 of the torque in stage 4, N·m per square degree
    // 40.1 π rad: the end of the yield stage, measured from where the nut is started on its thread.
    double theta_max_deg = 7218.0;
    double yield_width_deg = 90.0;  // width of the yield stage

    // Ours, because the paper does not give the real contact area A as a function of the angle. In stage 2
    // the product of A and the RMS slope h' of the rough surfaces in contact grows with the square of the
    // angle, over transition_width_deg, to contact_end_mm2, where the contact force is 0.3 kN.
    double transition_width_deg = 30.0;
    double contact_end_mm2 = 0.01;  // A·h' at the end of the transition
};

enum class Direction : std::uint8_t { tighten, loosen };

// Stage 1, N·m: T = −G (sin α ∓ μ cos α) d2/2; upper sign tightening; G: weight of
// the nut, N. −0.5761 N·mm with Table 1.
double published_navigation_torque(const PublishedParameters& p, Direction direction);

// Stage 2, N·m, at the product A·h' of real contact area and RMS slope (mm²), with F_c = A E* h'/κ (in kN, E
// in GPa): T1 = −(G ∓ F_c)(sin α + μ2 cos α) d2 and T2 = −π q μ1 ∫ r² dr from D2/2 to D1/2,
// with the pressure q = (F_c ∓ G)/(π/4 (D1² − D2²)). E*: effective modulus of the two faces.
double published_thread_torque(const PublishedParameters& p, double area_slope_mm2, Direction direction);
double published_bearing_torque(const PublishedParameters& p, double area_slope_mm2, Direction direction);

// Stage 3, torque per newton of clamp force (the lever arm of eq. 3), m; 12.464 mm tightening. For loosening,
// −ρ/2π replaces +ρ/2π (ours).
double published_lever(const PublishedParameters& p, Direction direction);
// Stage 3, angle per newton of clamp force; 8.684·10⁻⁴ °/N.
double published_degrees_per_newton(const PublishedParameters& p);
// Stage 3, slope of the tightening torque, the quotient of these two; 14.354 N·m per degree.
double published_linear_slope(const PublishedParameters& p);

// Stage 4, N·m, at the nut angle in degrees: T_max − κ1 (θ − θ_max)²; constant beyond θ_max (ours).
double published_yield_torque(const PublishedParameters& p, double theta_deg);

// The nut angle, degrees, at which tightening a new joint reaches `torque`, N·m, in stage 3 or 4. The law
// reaches at most T_max, so larger torques give θ_max, and negative ones the start of stage 3.
double published_angle(const PublishedParameters& p, double torque);

// Nut angle at which each stage begins, degrees from the start.
struct PublishedBoundaries {
    double transition, linearity, yield;
};
PublishedBoundaries published_boundaries(const PublishedParameters& p);

// State of a joint under this law. After the yield stage it unloads along the elastic line shifted by
// `set_deg` (ours).
struct PublishedState {
    double peak_deg = 0.0;  // furthest angle reached in the yield stage; 0 before
    double set_deg = 0.0;   // permanent shift of the elastic line
};

struct PublishedResponse {
    Stage stage = Stage::navigation;
    double torque = 0.0;  // N·m, with the paper's signs
    double clamp =
        0.0;  // N; in the transition F_c, the force of the touching faces; afterwards F_b, that of the bolt
};

// The law's response at this angle in this direction. Pure. `boundaries`: published_boundaries(p).
PublishedResponse evaluate_published(const PublishedParameters& p, const PublishedBoundaries& boundaries,
                                     const PublishedState& s, double theta_deg, Direction direction);
inline PublishedResponse evaluate_published(const PublishedParameters& p, const PublishedState& s,
                                            double theta_deg, Direction direction) {
    return evaluate_published(p, published_boundaries(p), s, theta_deg, direction);
}

// Updates peak and set after the nut has moved to theta_deg.
void published_advance(const PublishedParameters& p, const PublishedBoundaries& boundaries, PublishedState& s,
                       double theta_deg);
inline void published_advance(const PublishedParameters& p, PublishedState& s, double theta_deg) {
    published_advance(p, published_boundaries(p), s, theta_deg);
}

}  // namespace bolt::joint
