#include "content/format/read_joint_type.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/format/json_pointer.hpp"
#include "content/format/thread_text.hpp"
#include "content/format/wording.hpp"

namespace bolt::content {

namespace {

constexpr double mm = 1e-3;
constexpr double um = 1e-6;
constexpr double default_tolerance = 0.10;  // of the target torque
constexpr double default_snug = 0.25;       // of the target torque
constexpr double started_turns = 1.5;       // that a hand-started nut holds by

std::vector<joint::Member> read_members(const Layers& layers, const Materials& materials) {
    Reader& reader = layers.reader();
    std::vector<joint::Member> members;
    std::vector<std::string> names;
    for (const auto& [name, E] : materials.E) names.push_back(name);
    for (const Node& node : reader.items(layers.find("members"))) {
        joint::Member member;
        member.thickness = reader.number(reader.member(node, "thickness_mm")).value_or(0.0) * mm;
        const Node material = reader.member(node, "material");
        const auto name = reader.text(material);
        if (name && materials.E.contains(*name)) {
            member.E = materials.E.at(*name);
        } else if (name && materials.complete) {
            reader.report(material.pointer, fmt::format("{} is no material of this file", in_quotes(*name)),
                          meant(*name, names).empty() ? suggest(*name, names) + ", or add it to \"materials\""
                                                      : suggest(*name, names));
        }
        members.push_back(member);
    }
    return members;
}

joint::FrictionDesign read_friction(const Layers& layers) {
    joint::FrictionDesign friction;
    friction.thread = layers.number("friction_thread").value_or(friction.thread);
    friction.bearing = layers.number("friction_bearing").value_or(friction.bearing);
    friction.static_ratio = layers.number("friction_static_ratio").value_or(friction.static_ratio);
    friction.scatter = layers.number("friction_scatter_percent").value_or(friction.scatter * 100.0) / 100.0;
    const std::string lubrication = layers.text("lubrication").value_or("as_received");
    using joint::Lubrication;
    friction.lubrication = lubrication == "dry"     ? Lubrication::dry
                           : lubrication == "oiled" ? Lubrication::oiled
                           : lubrication == "mos2"  ? Lubrication::mos2
                                                    : Lubrication::as_received;
    return friction;
}

joint::JointDesign read_design(const Layers& layers, const Materials& materials) {
    Reader& reader = layers.reader();
    joint::JointDesign design{};
    if (const auto size = layers.text("size")) {
        if (auto thread = read_thread(*size))
            design.thread = *thread;
        else
            reader.report(size.pointer, thread.error().what, thread.error().expected);
    }
    if (const auto name = layers.text("class")) {
        if (auto found = joint::property_class(*name, design.thread.size.d))
            design.bolt_class = *found;
        else
            reader.report(name.pointer, found.error().what, found.error().expected);
    }
    design.nut_strength = layers.number("nut_proof_stress_MPa").value_or(0.0) * 1e6;
    design.bolt_length = layers.number("bolt_length_mm").value_or(0.0) * mm;
    design.bolt_thread_length = layers.number("bolt_thread_length_mm").value_or(0.0) * mm;
    design.washer_under_head = layers.boolean("washer_under_head").value_or(false);
    design.washer_under_nut = layers.boolean("washer_under_nut").value_or(false);
    design.members = read_members(layers, materials);
    design.member_diameter = layers.number("member_diameter_mm").value_or(0.0) * mm;
    design.friction = read_friction(layers);
    design.roughness_Rz = layers.number("roughness_Rz_um").value_or(design.roughness_Rz / um) * um;
    design.misfit = layers.number("misfit_um").value_or(design.misfit / um) * um;
    design.embedding_time = layers.number("embedding_time_s").value_or(design.embedding_time);
    design.prevailing_torque = layers.number("prevailing_torque_Nm").value_or(0.0);
    design.running_torque = layers.number("running_torque_Nm").value_or(design.running_torque);
    design.nut_mass = layers.number("nut_mass_g").value_or(0.0) * 1e-3;
    const double started =
        design.bolt_length - design.grip_length() - started_turns * design.thread.thread.pitch;
    design.start_gap = layers.number("start_gap_mm").value_or(std::max(started, 0.0) / mm) * mm;
    return design;
}

Specification read_spec(const Layers& spec) {
    Specification result;
    const std::string strategy = spec.text("strategy").value_or("torque");
    result.strategy = strategy == "yield"          ? Strategy::yield
                      : strategy == "torque_angle" ? Strategy::torque_angle
                                                   : Strategy::torque;
    result.torque = read_torque(spec);
    result.snug_torque = read_snug_torque(spec, result.torque);
    const auto low = spec.number("min_angle_deg"), high = spec.number("max_angle_deg");
    const auto target = spec.number("target_angle_deg");
    if (low && high) {
        result.has_angle = true;
        result.angle.low = to_radians(*low);
        result.angle.high = to_radians(*high);
        result.angle.target = target ? to_radians(*target) : 0.5 * (result.angle.low + result.angle.high);
    }
    result.target_clamp = spec.number("target_clamp_kN").value_or(0.0) * 1e3;
    const std::string risk = spec.text("risk_class").value_or("C");
    result.risk = risk == "A" ? RiskClass::A : risk == "B" ? RiskClass::B : RiskClass::C;
    return result;
}

}  // namespace

// Limits and a tolerance stand for each other: the topmost layer that has either decides.
Window read_torque(const Layers& spec) {
    Window torque;
    torque.target = spec.number("target_torque_Nm").value_or(0.0);
    torque.low = torque.target * (1.0 - default_tolerance);
    torque.high = torque.target * (1.0 + default_tolerance);
    for (const Node& object : spec.objects()) {
        const Layers layer(spec.reader(), {object});
        if (layer.find("min_torque_Nm") || layer.find("max_torque_Nm")) {
            torque.low = spec.number("min_torque_Nm").value_or(torque.low);
            torque.high = spec.number("max_torque_Nm").value_or(torque.high);
            break;
        }
        if (const auto tolerance = layer.number("torque_tolerance_percent")) {
            torque.low = torque.target * (1.0 - *tolerance / 100.0);
            torque.high = torque.target * (1.0 + *tolerance / 100.0);
            break;
        }
    }
    return torque;
}

double read_snug_torque(const Layers& spec, const Window& torque) {
    return spec.number("snug_torque_Nm").value_or(default_snug * torque.target);
}

Materials read_materials(Reader& reader) {
    Materials materials;
    materials.E = {{"aluminium", 70e9},     {"bronze", 105e9},          {"cast_iron", 110e9},
                   {"ductile_iron", 170e9}, {"stainless_steel", 200e9}, {"steel", 205e9}};
    const Node own = reader.member(reader.root(), "materials");
    materials.complete = reader.sound(own.pointer);
    for (const Node& node : reader.items(own))
        if (const auto E = reader.number(reader.member(node, "E_GPa")))
            materials.E[last_token(node.pointer)] = *E * 1e9;
    return materials;
}

JointType read_joint_type(const Layers& layers, const Materials& materials, double least_share) {
    const JointType type{read_design(layers, materials), read_spec(layers.inside("spec"))};
    check_joint_type(layers, type, least_share);
    return type;
}

}  // namespace bolt::content
