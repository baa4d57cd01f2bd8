// The design of a bolted joint in SI units, as read from content files, and what follows from it: torque
// levers, assembly preload and elastic compliance (VDI 2230). The joint laws are derived from it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::joint {

// Selects how friction changes with re-use (wear_of in mechanistic.cpp). FrictionDesign has the coefficients.
enum class Lubrication { as_received, dry, oiled, mos2 };

struct FrictionDesign {
    double thread = 0.12;        // μ_G, running
    double bearing = 0.12;       // μ_K, running, under the turned nut
    double static_ratio = 1.15;  // breakaway / running
    double scatter = 0.0;        // standard deviation of both from bolt to bolt, relative
    Lubrication lubrication = Lubrication::as_received;
};

struct Member {
    double thickness = 0.0;  // m, along the bolt
    double E = 0.0;          // Pa
};

struct JointDesign {
    std::string id;
    ThreadSize thread;
    PropertyClass bolt_class;
    double nut_strength = 0.0;      // Pa, proof stress of the nut (ISO 898-2); 0: matched to the bolt
    double bolt_length = 0.0;       // m, under the head
    double bolt_thread_length = 0;  // m; 0: ISO 4014
    bool washer_under_head = false;
    bool washer_under_nut = false;
    std::vector<Member> members;   // clamped parts, without washers
    double member_diameter = 0.0;  // m, D_A of VDI 2230 (outer diameter of the clamped part); 0: unlimited
    FrictionDesign friction;
    double roughness_Rz = 16e-6;   // m, of the faces; determines the amount of embedding
    double misfit = 5e-6;          // m, scale over which the seat closes (non-parallel faces, thread draw-in)
    double embedding_time = 5.0;   // s, time constant of embedding
    double prevailing_torque = 0;  // N·m, of a locking nut
    double running_drag = 0.02;    // N·m, mean drag of the free thread; it fluctuates with the angle
    double start_gap = 0.0;        // m, nut face to seat when the nut is hand-started (angle 0)
    double nut_mass = 0.0;         // kg; 0: from the nut's volume
    Vec3 seat{0.0};                // m, centre of the nut's seat in the assembly's frame
    Vec3 axis{0.0, 1.0, 0.0};      // unit, from the members towards the nut

    [[nodiscard]] double grip_length() const {  // l_K: members and washers
        double l = 0.0;
        for (const Member& m : members) l += m.thickness;
        const double washer = thread.size.washer_thickness;
        return l + (washer_under_head ? washer : 0.0) + (washer_under_nut ? washer : 0.0);
    }
};

// The lever arms of T = F (P/2π + μ_G r_t/cos β + μ_K r_b), m. Motosh, J. Eng. Ind. 98 (1976) 849.
struct TorqueLevers {
    double lead = 0.0;     // P/2π, the part that stretches the bolt
    double thread = 0.0;   // μ_G (d2/2) / cos β
    double bearing = 0.0;  // μ_K r_b, r_b effective bearing radius

    [[nodiscard]] double friction() const { return thread + bearing; }
    [[nodiscard]] double tighten() const { return lead + friction(); }
    [[nodiscard]] double loosen() const { return -lead + friction(); }  // torque against the nut's motion
};

TorqueLevers torque_levers(const ScrewThread& thread, double mu_thread, double mu_bearing,
                           double bearing_mean_diameter);

// D_Km = (d_w + d_h)/2, VDI 2230: mean diameter of the bearing under the turned nut or head.
inline double bearing_mean_diameter(double d_w, double d_h) { return 0.5 * (d_w + d_h); }

// tan(φ + ρ'), the slope on which the nut slides: φ lead angle, tan ρ' = friction_share · μ_G/cos β.
// friction_share in [−1, 1]: +1 tightening, −1 loosening. VDI 2230's closed forms use its first order, P/(π
// d2) + 1.155 μ_G. The exact tangent reproduces the published table A1 to its rounding, the closed form
// within 0.9 %.
double sliding_slope(const ScrewThread& thread, double mu_thread, double friction_share = 1.0);

// Ratio of equivalent (von Mises) to tensile stress while the thread torque acts: √(1 + 3 [κ (d2/d0) tan(φ +
// ρ')]²).
double equivalent_stress_ratio(const ScrewThread& thread, double mu_thread, double kappa,
                               double friction_share = 1.0);

struct AssemblyPreload {
    double force = 0.0;   // F_M, N
    double torque = 0.0;  // M_A, N·m
};

// VDI 2230 table A1: preload at which the equivalent stress is `utilisation` of R_p0.2, and its torque
// M_A = F_M (d2/2 tan(φ + ρ') + D_Km/2 μ_K).
AssemblyPreload assembly_preload(const ScrewThread& thread, const PropertyClass& bolt, double mu_thread,
                                 double mu_bearing, double bearing_mean_diameter, double utilisation = 0.9);

// Elastic compliance of the bolt, m/N, VDI 2230-1 section 5.1.1. δ_S: head (0.5 d), shank, free thread,
// engaged thread (0.5 d on the core) and nut (0.4 d).
double bolt_compliance(const ScrewThread& thread, double E, double grip, double shank);

// Elastic compliance of the clamped members, m/N, VDI 2230-1 section 5.1.2. δ_P of a stack of layers under
// the deformation cones of head and nut (through-bolted joint), concentric, with a cone that may be cut by
// the outer diameter D_A (0: unlimited; the cone's angle is then taken at D_A = 3 d_w). Layers of different
// modulus are integrated exactly along the cone.
double member_compliance(std::span<const Member> layers, double bearing_diameter, double hole, double D_A);

// Compliance of bolt and members of a design, m/N. The shank length follows from the bolt's thread length;
// washers are steel layers.
double joint_compliance(const JointDesign& design);

}  // namespace bolt::joint
