#include "game/measure/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/math.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::measure {

namespace {

constexpr double least_friction = 0.03, most_friction = 0.8;
constexpr double least_E = 1e9, most_E = 1e12;  // Pa; the schema's limit is 1000 GPa
constexpr int rounds = 40;                      // of the bisections

joint::JointDesign with_friction(joint::JointDesign design, double friction) {
    design.friction.thread = design.friction.bearing = friction;
    return design;
}

joint::JointDesign with_members(joint::JointDesign design, double E) {
    for (joint::Member& member : design.members) member.E = E;
    return design;
}

// Landmarks of the mechanistic law's curve up to `torque` (N·m); 0: to 40° beyond the beginning of yield.
Landmarks law_landmarks(joint::JointDesign design, double torque) {
    design.friction.scatter = 0.0;
    design.start_gap = 0.25 * design.thread.thread.pitch;
    joint::CurveOptions options;
    options.past_yield = to_radians(40.0);
    analysis::TorqueCurveBuilder builder(joint::Direction::tighten);
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), options)) {
        builder.add(s.angle, s.torque, s.stage);
        if (torque > 0.0 && s.torque >= torque) break;
    }
    return find_landmarks(builder.finish());
}

// The x between low and high at which `rising` passes `value`; none if it does not. Bisects the logarithm.
template <class Function>
std::optional<double> solve(double low, double high, double value, const Function& rising) {
    if (!(rising(low) <= value) || !(rising(high) >= value)) return std::nullopt;
    for (int i = 0; i < rounds; ++i) {
        const double middle = std::sqrt(low * high);
        (rising(middle) < value ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

std::optional<statistics::MeanDeviation> measured(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    return statistics::mean_deviation(values);
}

void collect(std::span<const Landmarks> runs, joint::Direction direction, JointFit& fit) {
    std::vector<double> slopes, yields, breakaways, free;
    for (const Landmarks& run : runs) {
        if (run.linear) slopes.push_back(run.linear->slope);
        if (run.yield) yields.push_back(run.yield->torque);
        if (run.free) free.push_back(std::abs(run.free->mean));
        if (direction == joint::Direction::loosen) breakaways.push_back(std::abs(run.peak.torque));
    }
    fit.slope = measured(slopes);
    // The joint has a yield load only if most runs yield.
    if (2 * yields.size() > runs.size()) fit.yield = measured(yields);
    fit.breakaway = measured(breakaways);
    fit.running = measured(free);
}

double slope_of(const joint::JointDesign& design, double torque) {
    const Landmarks l = law_landmarks(design, torque);
    return l.linear ? l.linear->slope : 0.0;
}

std::string compliance_text(double compliance) { return fmt::format("{:.3g} µm/kN", compliance * 1e9); }

// The modulus of the members that gives the measured slope up to `torque`.
std::optional<double> fitted_modulus(const joint::JointDesign& design, double slope, double torque) {
    return solve(least_E, most_E, slope, [&](double E) { return slope_of(with_members(design, E), torque); });
}

void tell_combination(const joint::JointDesign& design, double slope, double torque, JointFit& fit) {
    std::string text =
        "Friction and compliance cannot be told apart: without yield only their ratio (lever / compliance) "
        "is known. The compliance is";
    for (const double friction : {0.08, 0.12, 0.16, 0.20}) {
        const joint::JointDesign assumed = with_friction(design, friction);
        const auto E = fitted_modulus(assumed, slope, torque);
        text += fmt::format("{} {} with friction {:.2f}", friction > 0.08 ? "," : "",
                            E ? compliance_text(joint_compliance(with_members(assumed, *E))) : "not possible",
                            friction);
    }
    fit.unknown.push_back(text + ". A run into yield, or one with a measured clamp force, tells them apart.");
}

void fit_friction(JointFit& fit) {
    const auto friction = solve(least_friction, most_friction, fit.yield->mean,
                                [&](double mu) { return yield_torque(fit.design, mu); });
    if (!friction) {
        fit.unknown.push_back(
            fmt::format("No friction from {} to {} makes a bolt of class {} yield at {:.4g} N·m: check the "
                        "class and the size of the design. The friction is that of the design.",
                        least_friction, most_friction, fit.design.bolt_class.name, fit.yield->mean));
        return;
    }
    fit.friction = *friction;
    fit.friction_fitted = true;
    fit.design = with_friction(fit.design, *friction);
}

void tell_strength(JointFit& fit) {
    const auto with_strength = [&](double factor) {
        joint::JointDesign other = fit.design;
        other.bolt_class.R_p02 *= factor;
        other.bolt_class.R_m *= factor;
        return solve(least_friction, most_friction, fit.yield->mean,
                     [&](double mu) { return yield_torque(other, mu); })
            .value_or(nan);
    };
    fit.unknown.push_back(
        fmt::format("The friction assumes the nominal strength of class {}: {:.3f} if the bolt is 10 % "
                    "weaker, {:.3f} if it is 10 % stronger.",
                    fit.design.bolt_class.name, with_strength(0.9), with_strength(1.1)));
}

void fit_tightening(std::span<const Landmarks> runs, JointFit& fit) {
    std::vector<double> peaks;
    for (const Landmarks& run : runs) peaks.push_back(run.peak.torque);
    const double torque = fit.yield ? 0.0 : statistics::mean_deviation(peaks).mean;
    const joint::JointDesign given = fit.design;
    if (fit.yield) fit_friction(fit);
    // The yield torque depends a little on the compliance: a second round settles both.
    for (int round = 0; round < 2; ++round) {
        const auto E = fitted_modulus(fit.design, fit.slope->mean, torque);
        if (!E) {
            fit.unknown.push_back(fmt::format(
                "No modulus of the members from 1 to 1000 GPa gives the measured slope of {:.4g} N·m/°; the "
                "bolt alone may be too soft or too stiff: check size, length and friction of the design.",
                to_radians(fit.slope->mean)));
            break;
        }
        fit.members_E = *E;
        fit.design = with_members(fit.design, *E);
        fit.compliance = joint_compliance(fit.design);
        if (round == 0 && fit.friction_fitted) fit_friction(fit);
    }
    if (fit.friction_fitted)
        tell_strength(fit);
    else if (!fit.yield)
        tell_combination(given, fit.slope->mean, torque, fit);
    if (fit.compliance > 0.0)
        fit.unknown.emplace_back(
            "The compliance is that of the whole joint with its fixture; it is written as the modulus of the "
            "members, which need not be their material's.");
    fit.unknown.emplace_back(
        "Breakaway, embedding and wear: tightening alone does not show them; loosen, rest, and tighten "
        "again.");
}

void fit_loosening(JointFit& fit) {
    const joint::JointDesign& d = fit.design;
    const auto preload = [&](double mu) {
        const joint::TorqueLevers levers =
            joint::torque_levers(d.thread.thread, mu, mu, d.bearing_diameter());
        return fit.breakaway->mean / (d.friction.static_ratio * levers.friction() - levers.lead);
    };
    fit.preload = preload(fit.friction);
    fit.unknown.push_back(fmt::format(
        "Preload and friction cannot be told apart by a breakaway torque: {:.3g} kN with friction 0.08, "
        "{:.3g} kN with 0.12, {:.3g} kN with 0.20 (static / running friction {:g} as in the design).",
        preload(0.08) / 1e3, preload(0.12) / 1e3, preload(0.20) / 1e3, d.friction.static_ratio));
    fit.unknown.emplace_back("Compliance and yield: loosening runs do not determine them.");
}

// To a number of decimals, so that the file is short.
double rounded_to(double value, int decimals) {
    const double unit = std::pow(10.0, decimals);
    return std::round(value * unit) / unit;
}

}  // namespace

double yield_torque(const joint::JointDesign& design, double friction) {
    const Landmarks l = law_landmarks(with_friction(design, friction), 0.0);
    return l.yield ? l.yield->torque : l.peak.torque;
}

Result<JointFit> fit_joint(const joint::JointDesign& design, std::span<const Landmarks> runs,
                           joint::Direction direction) {
    JointFit fit;
    fit.design = design;
    fit.friction = 0.5 * (design.friction.thread + design.friction.bearing);
    collect(runs, direction, fit);
    if (fit.running && fit.running->mean > 0.0 && direction == joint::Direction::tighten)
        fit.design.running_drag = fit.running->mean;
    else
        fit.unknown.emplace_back("Running torque of the free nut: it is that of the design.");
    if (direction == joint::Direction::loosen) {
        if (runs.empty() || !(fit.breakaway->mean > 0.0))
            return fail(ErrorCode::failed, "there is no breakaway to fit", "loosening runs with a load");
        fit_loosening(fit);
    } else {
        if (!fit.slope)
            return fail(
                ErrorCode::failed,
                runs.empty() ? "there are no runs to fit" : "no run has a linear part: " + runs[0].missing,
                "runs that rise steadily, with at least 4 samples between 10 % and 90 % of their peak");
        if (design.members.empty())
            return fail(ErrorCode::failed, "the joint has no members whose modulus could be fitted",
                        "\"members\" in its joint type");
        fit_tightening(runs, fit);
    }
    fit.unknown.emplace_back(
        "Friction of thread and of bearing: torque and angle show only their sum; both are set equal. The "
        "clamp force is not measured.");
    return fit;
}

namespace {

// Adds the JSON members that distinguish a joint from a through-bolt whose nut is turned.
void add_form(const joint::JointDesign& d, nlohmann::ordered_json& type) {
    if (d.head != joint::HeadShape::hexagon) type["head"] = name(d.head);
    if (d.thread_direction != joint::ThreadDirection::right)
        type["thread_direction"] = name(d.thread_direction);
    if (d.locking_insert) type["locking_insert"] = true;
    if (!d.is_tapped()) {
        if (d.turned == joint::TurnedPart::head) type["turned"] = "head";
        if (d.counter_hold != joint::CounterHold::fixed) type["counter_hold"] = name(d.counter_hold);
        return;
    }
    type["form"] = name(d.form);
    const joint::TappedMaterial& part = d.hole.material;
    type["tapped_hole"] = {{"material", part.name},
                           {"E_GPa", rounded_to(part.E / 1e9, 3)},
                           {"tensile_strength_MPa", rounded_to(part.R_m / 1e6, 3)},
                           {"shear_ratio", rounded_to(part.shear_ratio, 4)},
                           {"engagement_mm", rounded_to(d.hole.engagement * 1e3, 4)}};
    if (d.hole.depth > 0.0) type["tapped_hole"]["depth_mm"] = rounded_to(d.hole.depth * 1e3, 4);
}

}  // namespace

std::string joint_type_json(const JointFit& fit, const std::string& name, double target_torque) {
    const joint::JointDesign& d = fit.design;
    using nlohmann::ordered_json;
    ordered_json type, members = ordered_json::array(), materials = ordered_json::object();
    for (std::size_t i = 0; i < d.members.size(); ++i) {
        const std::string material = fmt::format("{}_member_{}", name, i + 1);
        materials[material] = {{"E_GPa", rounded_to(d.members[i].E / 1e9, 2)}};
        members.push_back(
            {{"thickness_mm", rounded_to(d.members[i].thickness * 1e3, 4)}, {"material", material}});
    }
    type["size"] = joint::name(d.thread);
    type["class"] = d.bolt_class.name;
    add_form(d, type);
    type["bolt_length_mm"] = rounded_to(d.bolt_length * 1e3, 4);
    if (d.bolt_thread_length > 0.0) type["bolt_thread_length_mm"] = rounded_to(d.bolt_thread_length * 1e3, 4);
    type["members"] = members;
    if (d.member_diameter > 0.0) type["member_diameter_mm"] = rounded_to(d.member_diameter * 1e3, 4);
    type["washer_under_head"] = d.washer_under_head;
    type["washer_under_nut"] = d.washer_under_nut;
    type["friction_thread"] = rounded_to(d.friction.thread, 4);
    type["friction_bearing"] = rounded_to(d.friction.bearing, 4);
    if (d.friction.held_bearing) type["friction_held_bearing"] = rounded_to(*d.friction.held_bearing, 4);
    type["friction_static_ratio"] = rounded_to(d.friction.static_ratio, 4);
    type["friction_scatter_percent"] = rounded_to(100.0 * d.friction.scatter, 3);
    constexpr const char* lubrications[] = {"as_received", "dry", "oiled", "mos2"};
    type["lubrication"] = lubrications[static_cast<std::size_t>(d.friction.lubrication)];
    type["roughness_Rz_um"] = rounded_to(d.roughness_Rz * 1e6, 3);
    type["misfit_um"] = rounded_to(d.misfit * 1e6, 3);
    type["embedding_time_s"] = rounded_to(d.embedding_time, 3);
    if (d.nut_strength > 0.0) type["nut_proof_stress_MPa"] = rounded_to(d.nut_strength / 1e6, 3);
    if (d.prevailing_torque > 0.0 || d.locking_insert)
        type["prevailing_torque_Nm"] = rounded_to(d.prevailing_torque, 4);
    type["running_torque_Nm"] = rounded_to(d.running_drag, 4);
    type["start_gap_mm"] = rounded_to(d.start_gap * 1e3, 4);
    if (d.nut_mass > 0.0) type["nut_mass_g"] = rounded_to(d.nut_mass * 1e3, 4);
    type["spec"] = {{"strategy", "torque"}, {"target_torque_Nm", rounded_to(target_torque, 3)}};
    const ordered_json fragment = {{"materials", materials}, {"joint_types", {{name, type}}}};
    return fragment.dump(2) + "\n";
}

std::string fit_text(const JointFit& fit) {
    std::string out = "fit of the mechanistic law:\n";
    const auto line = [&](std::string_view name, const std::string& text) {
        out += fmt::format("  {:<18} {}\n", name, text);
    };
    const auto measured_line = [&](std::string_view name, const std::optional<statistics::MeanDeviation>& v,
                                   double factor, std::string_view unit) {
        if (!v) return;
        const std::string spread = v->n > 1 ? fmt::format(" ± {:.2g}", factor * v->deviation) : "";
        line(name, fmt::format("{:.4g}{} {}, {} run{}", factor * v->mean, spread, unit, v->n,
                               v->n == 1 ? "" : "s"));
    };
    measured_line("measured slope", fit.slope, to_radians(1.0), "N·m/°");
    measured_line("measured yield", fit.yield, 1.0, "N·m");
    measured_line("measured breakaway", fit.breakaway, 1.0, "N·m");
    measured_line("measured running", fit.running, 1.0, "N·m");
    line("friction", fmt::format("{:.3f}, {}", fit.friction,
                                 fit.friction_fitted ? "fitted to the yield torque" : "of the design"));
    if (fit.compliance > 0.0)
        line("compliance",
             fmt::format("{}, members of {:.3g} GPa", compliance_text(fit.compliance), fit.members_E / 1e9));
    if (fit.preload > 0.0) line("preload", fmt::format("{:.3g} kN at this friction", fit.preload / 1e3));
    out += "what the data cannot tell:\n";
    for (const std::string& text : fit.unknown) out += "  - " + text + "\n";
    return out;
}

}  // namespace bolt::measure
