// The design of a bolted joint in SI units, as read from content files, and what follows from it: torque
// levers, assembly preload and elastic compliance (VDI 2230). The joint laws are derived from it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/enum_names.hpp"
#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"
#include "haptics/joint/tapped_thread.hpp"

namespace bolt::joint {

// Selects how friction changes with re-use (wear_of in mechanistic.cpp). FrictionDesign has the coefficients.
enum class Lubrication { as_received, dry, oiled, mos2 };

struct FrictionDesign {
    double thread = 0.12;                  // μ_G, running
    double bearing = 0.12;                 // μ_K, running, under the turned part
    std::optional<double> held_bearing{};  // running, under the part that is not turned; none: as `bearing`
    double static_ratio = 1.15;            // breakaway / running
    // Standard deviation from bolt to bolt, as a share of the coefficient. The coefficients scatter
    // independently.
    double scatter = 0.0;
    Lubrication lubrication = Lubrication::as_received;
};

struct Member {
    double thickness = 0.0;  // m, along the bolt
    double E = 0.0;          // Pa
};

// The parts that hold the members together.
enum class JointForm : std::uint8_t {
    through_bolt,  // head and nut
    tapped_hole,   // a screw in the thread of the part behind the members
    stud           // a stud in such a thread, with a nut
};
inline constexpr EnumNames<JointForm, 3> joint_form_names{{"through_bolt", "tapped_hole", "stud"}};

// The name in assembly files.
constexpr std::string_view name(JointForm form) { return joint_form_names.of(form); }
// None if no form has this name.
constexpr std::optional<JointForm> joint_form_named(std::string_view text) {
    return joint_form_names.find(text);
}

enum class HeadShape : std::uint8_t { hexagon, socket };  // ISO 4014/4017; ISO 4762
inline constexpr EnumNames<HeadShape, 2> head_shape_names{{"hexagon", "socket"}};

// The name in assembly files and in the option --head.
constexpr std::string_view name(HeadShape shape) { return head_shape_names.of(shape); }
// None if no shape has this name.
constexpr std::optional<HeadShape> head_shape_named(std::string_view text) {
    return head_shape_names.find(text);
}

// A right-hand thread is tightened clockwise, seen from the side of the tool.
enum class ThreadDirection : std::uint8_t { right, left };
inline constexpr EnumNames<ThreadDirection, 2> thread_direction_names{{"right", "left"}};

// The name in assembly files.
constexpr std::string_view name(ThreadDirection direction) { return thread_direction_names.of(direction); }
// None if no direction has this name.
constexpr std::optional<ThreadDirection> thread_direction_named(std::string_view text) {
    return thread_direction_names.find(text);
}

// Follows the size of a thread in tables: " LH" (ISO 965-1), or empty for a right-hand thread.
constexpr std::string_view size_suffix(ThreadDirection direction) {
    return direction == ThreadDirection::left ? " LH" : "";
}

// The part that a tool turns.
enum class TurnedPart : std::uint8_t { nut, head };

// The held part of a through-bolt is the part that no tool turns: the head while the nut is turned, the nut
// while the head is turned. This enumeration states what keeps it from turning.
enum class CounterHold : std::uint8_t {
    fixed,         // it cannot turn
    second_wrench  // friction under it, and a second wrench while one is on it
};
inline constexpr EnumNames<CounterHold, 2> counter_hold_names{{"fixed", "second_wrench"}};

// The name in assembly files.
constexpr std::string_view name(CounterHold hold) { return counter_hold_names.of(hold); }
// None if no way has this name.
constexpr std::optional<CounterHold> counter_hold_named(std::string_view text) {
    return counter_hold_names.find(text);
}

// The thread that a screw or stud is screwed into.
struct TappedHole {
    TappedMaterial material;
    double engagement = 0.0;  // m, length of the engaged thread, with its chamfers
    double depth = 0.0;       // m, from its mouth to its bottom; 0: it goes through
};

struct JointDesign {
    std::string id;  // of the joint, from assembly.json
    JointForm form = JointForm::through_bolt;
    HeadShape head = HeadShape::hexagon;
    TurnedPart turned = TurnedPart::nut;            // a screw in a tapped hole: head
    TappedHole hole;                                // used if the form is tapped_hole or stud
    CounterHold counter_hold = CounterHold::fixed;  // second_wrench only with a through-bolt
    ThreadSize thread;
    // Does not affect the joint laws: their angle is positive in the direction that tightens.
    ThreadDirection thread_direction = ThreadDirection::right;
    PropertyClass bolt_class;
    double nut_strength = 0.0;      // Pa, proof stress of the nut (ISO 898-2); 0: matched to the bolt
    double bolt_length = 0.0;       // m, under the head; a stud: without its end in the hole
    double bolt_thread_length = 0;  // m; 0: ISO 4014, or ISO 4762 with a socket head
    bool washer_under_head = false;
    bool washer_under_nut = false;
    std::vector<Member> members;   // clamped parts, without washers
    double member_diameter = 0.0;  // m, D_A of VDI 2230 (outer diameter of the clamped part); 0: unlimited
    FrictionDesign friction;
    double roughness_Rz = 16e-6;   // m, of the faces; determines the embedding, by which load flattens them
    double misfit = 5e-6;          // m, distance over which misfitting faces close: added to u0 of SeatSpring
    double embedding_time = 5.0;   // s, time constant of embedding
    double prevailing_torque = 0;  // N·m, of a locking nut
    bool locking_insert = false;   // non-metallic (ISO 7040): acts once the bolt's end is in it, and wears
    double running_drag = 0.02;    // N·m, mean drag of the free thread; it fluctuates with the angle
    double start_gap = 0.0;        // m, nut face to seat when the nut is hand-started (angle 0)
    double nut_mass = 0.0;         // kg, of the turned part; 0: from its volume
    Vec3 seat{0.0};                // m, centre of the turned part's seat in the assembly's frame
    Vec3 axis{0.0, 1.0, 0.0};      // unit, from the members towards the turned part

    [[nodiscard]] double grip_length() const {  // l_K: members and washers
        double l = 0.0;
        for (const Member& m : members) l += m.thickness;
        const double washer = thread.size.washer_thickness;
        return l + (washer_under_head ? washer : 0.0) + (washer_under_nut ? washer : 0.0);
    }

    [[nodiscard]] bool is_tapped() const { return form != JointForm::through_bolt; }
    [[nodiscard]] double washer_under_turned() const {  // m, thickness; 0 without one
        return (turned == TurnedPart::head ? washer_under_head : washer_under_nut)
                   ? thread.size.washer_thickness
                   : 0.0;
    }
    // Length of the thread on the bolt, m: bolt_thread_length, or that of the standard if it is 0.
    [[nodiscard]] double thread_on_bolt() const;
    // Mean diameter of the bearing under the turned part, m: (d_w + d_h)/2.
    [[nodiscard]] double bearing_diameter() const;
};

// Dimensions of the part that is turned, m. `depth`: of a head's socket; 0: the tool grips it from outside.
struct TurnedPartSize {
    double across_flats = 0.0;  // width across flats that the tool must have
    double height = 0.0;
    double bearing = 0.0;  // d_w
    double depth = 0.0;
    double outside = 0.0;  // diameter of a head with a socket
};
TurnedPartSize turned_part_size(const JointDesign& design);

// Height of the nut, m; a locking nut is higher.
double nut_height(const JointDesign& design);

// The lever arms of T = F (P/2π + μ_G r_t/cos β + μ_K r_b), m: T torque, F clamp force, r_t = d2/2, r_b
// effective bearing radius. Motosh, J. Eng. Ind. 98 (1976) 849.
struct TorqueLevers {
    double lead = 0.0;     // P/2π, the part that stretches the bolt
    double thread = 0.0;   // μ_G r_t / cos β
    double bearing = 0.0;  // μ_K r_b

    [[nodiscard]] double friction() const { return thread + bearing; }
    [[nodiscard]] double tightening_lever() const { return lead + friction(); }
    // Positive: loosening needs a torque. Negative: the nut loosens by itself.
    [[nodiscard]] double loosening_lever() const { return -lead + friction(); }
};

TorqueLevers torque_levers(const ScrewThread& thread, double mu_thread, double mu_bearing,
                           double bearing_mean_diameter);

// The torques on the held part of a through-bolt that is tightened to the clamp force F. The thread turns it
// with F (P/2π + μ_G r_t/cos β) and the prevailing torque; friction under it holds it with up to F μ r_b.
// With equal coefficients, friction alone holds it above μ ≈ 0.20 (M8) to 0.22 (M12).
struct HeldPartTorques {
    double thread = 0.0;    // N·m
    double friction = 0.0;  // N·m, at most

    // N·m that a second wrench on the held part bears; 0: friction alone holds it.
    [[nodiscard]] double second_wrench() const { return std::max(0.0, thread - friction); }
};
HeldPartTorques held_part_torques(const JointDesign& design, double clamp);

// Dimensions of the held part of a through-bolt, m: of its head, or of its nut if the head is turned.
struct HeldPartSize {
    double across_flats = 0.0;
    double height = 0.0;
    double bearing = 0.0;  // d_w
};
HeldPartSize held_part_size(const JointDesign& design);

// D_Km = (d_w + d_h)/2, VDI 2230: mean diameter of the bearing under the turned nut or head.
inline double bearing_mean_diameter(double d_w, double d_h) { return 0.5 * (d_w + d_h); }

// tan(φ + ρ'), the slope on which the nut slides: φ lead angle, tan ρ' = friction_share · μ_G/cos β.
// friction_share in [−1, 1]: +1 tightening, −1 loosening. The closed form of VDI 2230 is the first-order
// approximation P/(π d2) + 1.155 μ_G. The exact tangent reproduces table A1 of VDI 2230 to its rounding, the
// closed form within 0.9 %.
inline double sliding_slope(const ScrewThread& thread, double mu_thread, double friction_share = 1.0) {
    const double lead = thread.pitch / (pi * thread.d2);
    const double friction = friction_share * mu_thread / std::cos(thread_half_angle);
    return (lead + friction) / (1.0 - lead * friction);
}

// Ratio of equivalent (von Mises) to tensile stress while the thread torque acts: √(1 + 3 [κ (d2/d0) tan(φ +
// ρ')]²). κ: PropertyClass::kappa; d2 and d0: mean diameter of the thread and diameter of its stress section.
inline double equivalent_stress_ratio(const ScrewThread& thread, double mu_thread, double kappa,
                                      double friction_share = 1.0) {
    const double shear = kappa * (thread.d2 / thread.d0()) * sliding_slope(thread, mu_thread, friction_share);
    return std::sqrt(1.0 + 3.0 * square(shear));
}

struct AssemblyPreload {
    double force = 0.0;   // F_M, N
    double torque = 0.0;  // M_A, N·m
};

// VDI 2230 table A1: preload at which the equivalent stress is `utilisation` of R_p0.2, and its torque
// M_A = F_M (d2/2 tan(φ + ρ') + D_Km/2 μ_K).
AssemblyPreload assembly_preload(const ScrewThread& thread, const PropertyClass& bolt, double mu_thread,
                                 double mu_bearing, double bearing_mean_diameter, double utilisation = 0.9);

// The ends of a bolt as cylinders of its nominal section, VDI 2230-1 section 5.1.1: their lengths as shares
// of d. Each thread that is engaged adds 0.5 d of the core section.
struct BoltEnds {
    double head = 0.5;           // 0.5 hexagon, 0.4 socket; 0 for a stud
    double nut = 0.4;            // 0 for a screw in a tapped hole
    double engaged_threads = 1;  // a stud has two
    double tapped = 0.0;         // 0.33 with a tapped hole
    double tapped_E = 0.0;       // Pa, of the tapped part
};
BoltEnds bolt_ends(const JointDesign& design);

// Elastic compliance δ_S of the bolt, m/N, VDI 2230-1 section 5.1.1: the sum of those of its ends, its shank,
// the free thread and the engaged threads. `grip`: grip length, m. `shank`: length without thread, m.
double bolt_compliance(const ScrewThread& thread, double E, double grip, double shank,
                       const BoltEnds& ends = {});

// Number of deformation cones in the members. The value of an enumerator is w of VDI 2230.
enum class DeformationCones : std::uint8_t { two = 1, one = 2 };

// Elastic compliance of the clamped members, m/N, VDI 2230-1 section 5.1.2. δ_P of a stack of layers under
// the concentric deformation cones of head and nut. The outer diameter D_A may cut the cones; 0: unlimited,
// and the cones have the angle that belongs to D_A = 3 d_w. Layers of different modulus are integrated
// exactly along the cone. With a tapped hole there is one cone, from the bearing face to the tapped part;
// `layers` must then begin at the bearing face.
double member_compliance(std::span<const Member> layers, double bearing_diameter, double hole, double D_A,
                         DeformationCones cones = DeformationCones::two);

// Compliance of bolt and members of a design, m/N. The shank length follows from the bolt's thread length;
// washers are steel layers.
double joint_compliance(const JointDesign& design);

}  // namespace bolt::joint
