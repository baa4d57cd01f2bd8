#include <fmt/format.h>

#include <algorithm>

#include "content/format/read_joint_type.hpp"
#include "haptics/joint/torque.hpp"

namespace bolt::content {

namespace {

constexpr double mm = 1e-3;
constexpr double slack = 1e-9;  // m, against rounding of decimal millimetres

void check_lengths(const Layers& layers, const joint::JointDesign& design) {
    Reader& reader = layers.reader();
    const std::string length_at = layers.find("bolt_length_mm").pointer;
    const double grip = design.grip_length();
    const double needed = grip + design.thread.size.nut_height + design.thread.thread.pitch;
    if (design.bolt_length < needed - slack) {
        reader.report(length_at,
                      fmt::format("a bolt of {:g} mm is too short for a grip of {:g} mm and a nut of {:g} mm",
                                  design.bolt_length / mm, grip / mm, design.thread.size.nut_height / mm),
                      fmt::format("expected at least {:g} mm", needed / mm));
        return;
    }
    const Node thread_node = layers.find("bolt_thread_length_mm");
    if (design.bolt_thread_length > design.bolt_length + slack) {
        reader.report(
            thread_node.pointer,
            fmt::format("a thread of {:g} mm is longer than its bolt", design.bolt_thread_length / mm),
            fmt::format("expected at most {:g} mm", design.bolt_length / mm));
        return;
    }
    const double thread = design.bolt_thread_length > 0.0
                              ? design.bolt_thread_length
                              : joint::thread_length(design.thread.size.d, design.bolt_length);
    if (grip < design.bolt_length - thread - slack)
        reader.report(
            thread_node ? thread_node.pointer : length_at,
            fmt::format("the nut cannot reach its seat: the thread ends {:g} mm under the head, the grip is "
                        "{:g} mm",
                        (design.bolt_length - thread) / mm, grip / mm),
            fmt::format("expected a shorter bolt, or bolt_thread_length_mm of at least {:g}",
                        (design.bolt_length - grip) / mm));
    const Node gap = layers.find("start_gap_mm");
    if (gap && design.start_gap > design.bolt_length - grip + slack)
        reader.report(gap.pointer,
                      fmt::format("a gap of {:g} mm is beyond the bolt's end", design.start_gap / mm),
                      fmt::format("expected less than {:g} mm", (design.bolt_length - grip) / mm));
    const Node diameter = layers.find("member_diameter_mm");
    if (diameter && design.member_diameter < design.thread.size.nut_bearing)
        reader.report(diameter.pointer,
                      fmt::format("members of {:g} mm diameter are smaller than the nut's bearing face",
                                  design.member_diameter / mm),
                      fmt::format("expected at least {:g} mm", design.thread.size.nut_bearing / mm));
}

void check_load(const Layers& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    const joint::FastenerSize& size = design.thread.size;
    const joint::AssemblyPreload yield = joint::assembly_preload(
        design.thread.thread, design.bolt_class, design.friction.thread, design.friction.bearing,
        joint::bearing_mean_diameter(size.nut_bearing, size.hole));
    const Layers spec = layers.inside("spec");
    // Beyond yield a bolt hardens by less than this; a higher target breaks it or is a slip of the decimal
    // point.
    const double most = 1.3 * yield.torque + design.prevailing_torque;
    if (type.spec.torque.target > most)
        layers.reader().report(
            spec.find("target_torque_Nm").pointer,
            fmt::format("{:g} N·m is too much for {} of class {} with friction {:g} and {:g}: it yields near "
                        "{:.0f} N·m",
                        type.spec.torque.target, size.name, design.bolt_class.name, design.friction.thread,
                        design.friction.bearing, yield.torque + design.prevailing_torque),
            fmt::format("expected at most {:.0f} N·m", most));
    const double strength = design.bolt_class.R_m * design.thread.thread.A_s;
    if (type.spec.target_clamp > strength)
        layers.reader().report(spec.find("target_clamp_kN").pointer,
                               fmt::format("{:g} kN breaks {} of class {}", type.spec.target_clamp * 1e-3,
                                           size.name, design.bolt_class.name),
                               fmt::format("expected less than {:.1f} kN", strength * 1e-3));
}

// Limits come in pairs, and a tolerance stands instead of them.
void check_pairs(const Layers& spec) {
    Reader& reader = spec.reader();
    const auto pair = [&](const char* low, const char* high) {
        const Node low_node = spec.find(low), high_node = spec.find(high);
        const auto alone = [&](const Node& node, const char* here, const char* other) {
            reader.report(node.pointer, fmt::format("\"{}\" without \"{}\"", here, other),
                          "expected both or neither", Part::key);
        };
        if (low_node && !high_node) alone(low_node, low, high);
        if (high_node && !low_node) alone(high_node, high, low);
    };
    pair("min_torque_Nm", "max_torque_Nm");
    pair("min_angle_deg", "max_angle_deg");
    for (const Node& object : spec.objects()) {
        const Layers layer(reader, {object});
        const Node tolerance = layer.find("torque_tolerance_percent");
        if (tolerance && (layer.find("min_torque_Nm") || layer.find("max_torque_Nm")))
            reader.report(tolerance.pointer, "both a tolerance and limits of the torque",
                          "expected one or the other", Part::key);
    }
}

void check_windows(const Layers& spec, const Specification& s) {
    Reader& reader = spec.reader();
    const auto at = [&](const char* key) {
        const Node node = spec.find(key);
        return node ? node.pointer : spec.objects().front().pointer;
    };
    check_pairs(spec);
    const Window& torque = s.torque;
    if (torque.low > torque.target)
        reader.report(at("min_torque_Nm"), fmt::format("{:g} N·m is above the target", torque.low),
                      fmt::format("expected at most {:g} N·m", torque.target));
    if (torque.high < torque.target)
        reader.report(at("max_torque_Nm"), fmt::format("{:g} N·m is below the target", torque.high),
                      fmt::format("expected at least {:g} N·m", torque.target));
    if (s.snug_torque >= torque.low && torque.low <= torque.target)
        reader.report(
            at("snug_torque_Nm"),
            fmt::format("a snug torque of {:g} N·m is no less than what is judged OK", s.snug_torque),
            fmt::format("expected less than {:g} N·m", torque.low));
    if (s.has_angle) {
        const double target = to_degrees(s.angle.target);
        if (s.angle.low > s.angle.high)
            reader.report(at("min_angle_deg"),
                          fmt::format("{:g} degrees is above the largest angle", to_degrees(s.angle.low)),
                          fmt::format("expected at most {:g}", to_degrees(s.angle.high)));
        else if (target < to_degrees(s.angle.low) - 1e-9 || target > to_degrees(s.angle.high) + 1e-9)
            reader.report(
                at("target_angle_deg"), fmt::format("{:g} degrees is outside its window", target),
                fmt::format("expected {:g} to {:g}", to_degrees(s.angle.low), to_degrees(s.angle.high)));
    } else if (s.strategy == Strategy::torque_angle) {
        reader.report(
            at("strategy"), "the strategy torque_angle needs an angle",
            "expected min_angle_deg and max_angle_deg, and target_angle_deg where it is not their middle");
    } else if (const Node target = spec.find("target_angle_deg")) {
        reader.report(target.pointer, "a target angle without a window",
                      "expected min_angle_deg and max_angle_deg too");
    }
}

}  // namespace

void check_joint_type(const Layers& layers, const JointType& type) {
    const bool materials_known = std::all_of(type.design.members.begin(), type.design.members.end(),
                                             [](const joint::Member& m) { return m.thickness > 0.0; });
    if (materials_known) check_lengths(layers, type.design);
    check_load(layers, type);
    check_windows(layers.inside("spec"), type.spec);
}

}  // namespace bolt::content
