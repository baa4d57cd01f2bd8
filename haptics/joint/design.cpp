#include "haptics/joint/design.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bolt::joint {

TorqueLevers torque_levers(const ScrewThread& thread, double mu_thread, double mu_bearing,
                           double bearing_mean_diameter) {
    TorqueLevers levers;
    levers.lead = thread.pitch / (2.0 * pi);
    levers.thread = mu_thread * 0.5 * thread.d2 / std::cos(thread_half_angle);
    levers.bearing = mu_bearing * 0.5 * bearing_mean_diameter;
    return levers;
}

HeldPartSize held_part_size(const JointDesign& design) {
    const FastenerSize& size = design.thread.size;
    if (design.turned == TurnedPart::head) return {size.across_flats, nut_height(design), size.nut_bearing};
    return {size.across_flats, size.head_height, size.head_bearing};
}

HeldPartTorques held_part_torques(const JointDesign& design, double clamp) {
    const double diameter = bearing_mean_diameter(held_part_size(design).bearing, design.thread.size.hole);
    const TorqueLevers levers =
        torque_levers(design.thread.thread, design.friction.thread,
                      design.friction.held_bearing.value_or(design.friction.bearing), diameter);
    return {clamp * (levers.lead + levers.thread) + design.prevailing_torque, clamp * levers.bearing};
}

AssemblyPreload assembly_preload(const ScrewThread& thread, const PropertyClass& bolt, double mu_thread,
                                 double mu_bearing, double bearing_mean_diameter, double utilisation) {
    AssemblyPreload preload;
    const double stress = utilisation * bolt.R_p02 / equivalent_stress_ratio(thread, mu_thread, bolt.kappa);
    preload.force = stress * thread.A_s;
    const double thread_lever = 0.5 * thread.d2 * sliding_slope(thread, mu_thread);
    preload.torque = preload.force * (thread_lever + 0.5 * bearing_mean_diameter * mu_bearing);
    return preload;
}

double JointDesign::thread_on_bolt() const {
    if (bolt_thread_length > 0.0) return bolt_thread_length;
    if (head == HeadShape::socket) return socket_screw_thread_length(thread.size.d, bolt_length);
    return thread_length(thread.size.d, bolt_length);
}

double JointDesign::bearing_diameter() const {
    return bearing_mean_diameter(turned_part_size(*this).bearing, thread.size.hole);
}

TurnedPartSize turned_part_size(const JointDesign& design) {
    const FastenerSize& size = design.thread.size;
    if (design.turned == TurnedPart::head) {
        const SocketHead* const socket = design.head == HeadShape::socket ? socket_head(size.name) : nullptr;
        if (socket)
            return {socket->across_flats, socket->height, socket->bearing, socket->depth, socket->diameter};
        return {size.across_flats, size.head_height, size.head_bearing, 0.0, 0.0};
    }
    return {size.across_flats, nut_height(design), size.nut_bearing, 0.0, 0.0};
}

double nut_height(const JointDesign& design) {
    const FastenerSize& size = design.thread.size;
    const LockingNut* const locking = design.locking_insert ? locking_nut(size.name) : nullptr;
    return locking ? locking->height : size.nut_height;
}

BoltEnds bolt_ends(const JointDesign& design) {
    const double head = design.head == HeadShape::socket ? 0.4 : 0.5;
    constexpr double nut = 0.4, tapped = 0.33;
    switch (design.form) {
        case JointForm::tapped_hole:
            return {head, 0.0, 1.0, tapped, design.hole.material.E};
        case JointForm::stud:
            return {0.0, nut, 2.0, tapped, design.hole.material.E};
        case JointForm::through_bolt:
            break;
    }
    return {head, nut, 1.0, 0.0, 0.0};
}

// The sum keeps its order: recorded sessions replay to the bit.
double bolt_compliance(const ScrewThread& thread, double E, double grip, double shank, const BoltEnds& ends) {
    const double smooth = std::clamp(shank, 0.0, grip);
    const double head = ends.head * thread.d / thread.A_N();
    const double shaft = smooth / thread.A_N();
    const double free_thread = (grip - smooth) / thread.A_d3();
    const double engaged = 0.5 * ends.engaged_threads * thread.d / thread.A_d3();
    const double nut = ends.nut * thread.d / thread.A_N();
    const double tapped = ends.tapped > 0.0 ? ends.tapped * thread.d / (thread.A_N() * ends.tapped_E) : 0.0;
    return (head + shaft + free_thread + engaged + nut) / E + tapped;
}

namespace {

// ∫ dz / (π/4 (D(z)² − d_h²)) from D0 to D1 along a cone of slope dD/dz = 2 tan φ.
double cone_integral(double D0, double D1, double hole, double tan_phi) {
    const double ratio = (D1 - hole) * (D0 + hole) / ((D1 + hole) * (D0 - hole));
    return std::log(ratio) / (pi * hole * tan_phi);
}

}  // namespace

double member_compliance(std::span<const Member> layers, double bearing_diameter, double hole, double D_A,
                         DeformationCones cones) {
    double grip = 0.0;
    for (const Member& layer : layers) grip += layer.thickness;
    if (grip <= 0.0) return 0.0;

    const double d_w = bearing_diameter;
    const double y = (D_A > d_w ? D_A : 3.0 * d_w) / d_w;
    // VDI 2230-1 (5.1/27) for a through-bolted joint (w = 1) and (5.1/26) for a tapped one, β_L = l_K/d_w.
    const bool two = cones == DeformationCones::two;
    const double tan_phi = two ? 0.362 + 0.032 * std::log(0.5 * grip / d_w) + 0.153 * std::log(y)
                               : 0.348 + 0.013 * std::log(grip / d_w) + 0.193 * std::log(y);
    const double limit = D_A > 0.0 ? std::max(D_A, d_w) : 1e9;

    // Two cones: the diameter grows from d_w at either end to the middle of the grip, and stops at D_A: cone,
    // then sleeve. One cone: it grows from the bearing face to the end of the grip.
    const auto diameter = [&](double z) {
        return std::min(d_w + 2.0 * tan_phi * (two ? std::min(z, grip - z) : z), limit);
    };
    const double cone_end = std::min(two ? 0.5 * grip : grip, 0.5 * (limit - d_w) / tan_phi);
    const double breaks[] = {0.0, cone_end, two ? grip - cone_end : grip, grip};

    double compliance = 0.0;
    double begin = 0.0;
    for (const Member& layer : layers) {
        const double end = begin + layer.thickness;
        for (int i = 0; i < 3; ++i) {
            const double z0 = std::max(begin, breaks[i]);
            const double z1 = std::min(end, breaks[i + 1]);
            if (z1 <= z0) continue;
            const double D0 = diameter(z0), D1 = diameter(z1);
            const double area_integral =
                i == 1 ? (z1 - z0) / (0.25 * pi * (square(limit) - square(hole)))
                       : cone_integral(std::min(D0, D1), std::max(D0, D1), hole, tan_phi);
            compliance += area_integral / layer.E;
        }
        begin = end;
    }
    return compliance;
}

double joint_compliance(const JointDesign& design) {
    constexpr double steel = 205e9;
    const FastenerSize& size = design.thread.size;
    std::vector<Member> layers = design.members;
    if (design.washer_under_head) layers.insert(layers.begin(), Member{size.washer_thickness, steel});
    if (design.washer_under_nut) layers.push_back(Member{size.washer_thickness, steel});
    // The cone of a stud begins under its nut, which is at the end of the list.
    if (design.form == JointForm::stud) std::reverse(layers.begin(), layers.end());
    return bolt_compliance(design.thread.thread, design.bolt_class.E, design.grip_length(),
                           design.bolt_length - design.thread_on_bolt(), bolt_ends(design)) +
           member_compliance(layers, turned_part_size(design).bearing, size.hole, design.member_diameter,
                             design.is_tapped() ? DeformationCones::one : DeformationCones::two);
}

}  // namespace bolt::joint
