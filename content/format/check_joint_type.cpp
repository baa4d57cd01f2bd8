#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "content/format/read_joints.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::content {

namespace {

constexpr double mm = 1e-3;
constexpr double slack = 1e-9;  // m, against rounding of decimal millimetres

bool has_size(const JointType& type) { return type.design.thread.size.d > 0.0; }
bool has_class(const JointType& type) { return type.design.bolt_class.R_p02 > 0.0; }

// The largest limit that a message can name and that is then taken.
double rounded_down(double torque) { return std::floor(torque * 10.0) / 10.0; }

void check_thread_length(const Layers& layers, const joint::JointDesign& design) {
    Reader& reader = layers.reader();
    const double grip = design.grip_length();
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
            thread_node ? thread_node.pointer : layers.find("bolt_length_mm").pointer,
            fmt::format("the nut cannot reach its seat: the thread ends {:g} mm under the head, the grip is "
                        "{:g} mm",
                        (design.bolt_length - thread) / mm, grip / mm),
            fmt::format("expected a shorter bolt, or bolt_thread_length_mm of at least {:g}",
                        (design.bolt_length - grip) / mm));
}

// Needs the size, the bolt's length and the whole grip.
void check_lengths(const Layers& layers, const joint::JointDesign& design) {
    Reader& reader = layers.reader();
    const double grip = design.grip_length();
    const double needed = grip + design.thread.size.nut_height + design.thread.thread.pitch;
    if (design.bolt_length < needed - slack) {
        reader.report(layers.find("bolt_length_mm").pointer,
                      fmt::format("a bolt of {:g} mm is too short for a grip of {:g} mm and a nut of {:g} mm",
                                  design.bolt_length / mm, grip / mm, design.thread.size.nut_height / mm),
                      fmt::format("expected at least {:g} mm", needed / mm));
        return;
    }
    if (layers.known({"bolt_thread_length_mm"})) check_thread_length(layers, design);
    const Node gap = layers.find("start_gap_mm");
    if (gap && design.start_gap > design.bolt_length - grip + slack)
        reader.report(gap.pointer,
                      fmt::format("a gap of {:g} mm is beyond the bolt's end", design.start_gap / mm),
                      fmt::format("expected less than {:g} mm", (design.bolt_length - grip) / mm));
}

void check_member_diameter(const Layers& layers, const joint::JointDesign& design) {
    const Node diameter = layers.find("member_diameter_mm");
    if (diameter && design.member_diameter < design.thread.size.nut_bearing)
        layers.reader().report(
            diameter.pointer,
            fmt::format("members of {:g} mm diameter are smaller than the nut's bearing face",
                        design.member_diameter / mm),
            fmt::format("expected at least {:g} mm", design.thread.size.nut_bearing / mm));
}

void check_clamp(const Layers& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    const double strength = design.bolt_class.R_m * design.thread.thread.A_s;
    if (type.spec.target_clamp > strength)
        layers.reader().report(layers.inside("spec").find("target_clamp_kN").pointer,
                               fmt::format("{:g} kN breaks {} of class {}", type.spec.target_clamp * 1e-3,
                                           design.thread.size.name, design.bolt_class.name),
                               fmt::format("expected less than {:.1f} kN", strength * 1e-3));
}

// Needs the size, the class, the friction and the target torque.
void check_load(const Layers& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    const joint::FastenerSize& size = design.thread.size;
    constexpr double utilisation = 0.9;
    const double torque_90 =
        joint::assembly_preload(design.thread.thread, design.bolt_class, design.friction.thread,
                                design.friction.bearing,
                                joint::bearing_mean_diameter(size.nut_bearing, size.hole), utilisation)
            .torque;
    const double yields = torque_90 / utilisation + design.prevailing_torque;
    const Layers spec = layers.inside("spec");
    const Node target = spec.find("target_torque_Nm"), limit = spec.find("max_torque_Nm");
    const auto too_much = [&](const Node& at, double torque, const char* of, double most,
                              const char* in_all) {
        layers.reader().report(
            at.pointer,
            fmt::format("{:g} N·m{} is too much for {} of class {} with friction {:g} and {:g}: it yields "
                        "near {:.1f} N·m",
                        torque, of, size.name, design.bolt_class.name, design.friction.thread,
                        design.friction.bearing, rounded_down(yields)),
            fmt::format("expected at most {:.1f} N·m{}", rounded_down(most), in_all));
    };
    const Window& torque = type.spec.torque;
    if (type.spec.strategy == Strategy::yield) {
        // Beyond yield a bolt hardens by less than this; a higher target breaks it or is a slip of the
        // decimal point.
        const double most = 1.3 * torque_90 + design.prevailing_torque;
        if (torque.target > most) too_much(target, torque.target, "", most, "");
    } else if (torque.high > yields) {
        const bool limited = limit && layers.reader().number(limit) == torque.high;
        const char* in_all = limited ? "" : " with its tolerance";
        if (torque.target > yields)
            too_much(target, torque.target, "", yields, in_all);
        else
            too_much(limited ? limit : target, torque.high, limited ? "" : " (the target with its tolerance)",
                     yields, in_all);
    }
}

// The largest prevailing torque of a locking nut of class 8 when it is first run on, ISO 2320; 0: not known.
double largest_prevailing(std::string_view size) {
    constexpr std::pair<std::string_view, double> largest[] = {
        {"M8", 6.0}, {"M10", 10.5}, {"M12", 15.5}, {"M16", 32.0}, {"M20", 54.0}};
    for (const auto& [name, torque] : largest)
        if (name == size) return torque;
    return 0.0;
}

// A nut that takes all of the torque leaves none to load the bolt.
void check_prevailing(const Layers& layers, const JointType& type, double least_share) {
    constexpr double margin = 1.5;  // over ISO 2320: other classes, coatings, dry threads
    const Node node = layers.find("prevailing_torque_Nm");
    const double prevailing = type.design.prevailing_torque, target = type.spec.torque.target;
    if (!node || prevailing <= 0.0) return;
    const bool target_known = static_cast<bool>(layers.inside("spec").find("target_torque_Nm"));
    const double least = target_known ? least_share * target : std::numeric_limits<double>::infinity();
    const double usual = largest_prevailing(type.design.thread.size.name);
    const double most = usual > 0.0 ? margin * usual : std::numeric_limits<double>::infinity();
    if (prevailing >= least)
        layers.reader().report(
            node.pointer,
            fmt::format(
                "a nut that takes {:g} N·m to turn never loads its bolt in a pass that tightens to {:g} N·m "
                "({:g} percent of {:g})",
                prevailing, least, least_share * 100.0, target),
            most < least ? fmt::format("expected at most {:g} N·m", most)
                         : fmt::format("expected less than {:g} N·m{}", least,
                                       least_share < 1.0 ? ", or a higher percentage" : ""));
    else if (prevailing > most)
        layers.reader().report(node.pointer,
                               fmt::format("{:g} N·m is too much for a locking nut {}: ISO 2320 allows {:g} "
                                           "N·m (class 8, first assembly)",
                                           prevailing, type.design.thread.size.name, usual),
                               fmt::format("expected at most {:g} N·m", most));
}

std::string place_of(const Layers& spec, const char* key) {
    const Node node = spec.find(key);
    return node ? node.pointer : spec.objects().front().pointer;
}

void check_angles(const Layers& spec, const Specification& s) {
    Reader& reader = spec.reader();
    if (s.has_angle) {
        const double target = to_degrees(s.angle.target);
        if (s.angle.low > s.angle.high)
            reader.report(place_of(spec, "min_angle_deg"),
                          fmt::format("{:g} degrees is above the largest angle", to_degrees(s.angle.low)),
                          fmt::format("expected at most {:g}", to_degrees(s.angle.high)));
        else if (target < to_degrees(s.angle.low) - 1e-9 || target > to_degrees(s.angle.high) + 1e-9)
            reader.report(
                place_of(spec, "target_angle_deg"), fmt::format("{:g} degrees is outside its window", target),
                fmt::format("expected {:g} to {:g}", to_degrees(s.angle.low), to_degrees(s.angle.high)));
    } else if (s.strategy == Strategy::torque_angle) {
        reader.report(
            place_of(spec, "strategy"), "the strategy torque_angle needs an angle",
            "expected min_angle_deg and max_angle_deg, and target_angle_deg where it is not their middle");
    } else if (const Node target = spec.find("target_angle_deg")) {
        reader.report(target.pointer, "a target angle without a window",
                      "expected min_angle_deg and max_angle_deg too");
    }
}

}  // namespace

void check_limits(const Layers& spec) {
    Reader& reader = spec.reader();
    const auto pair = [&](const char* low, const char* high) {
        const Node low_node = spec.find(low), high_node = spec.find(high);
        const auto alone = [&](const Node& node, const char* here, const char* other) {
            reader.report(node.pointer, fmt::format("\"{}\" without \"{}\"", here, other),
                          "expected both or neither", Part::key);
        };
        if (!spec.known({low, high})) return;
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

void check_torques(const Layers& spec, const Window& torque, double snug_torque) {
    Reader& reader = spec.reader();
    if (torque.low > torque.target)
        reader.report(place_of(spec, "min_torque_Nm"),
                      fmt::format("{:g} N·m is above the target", torque.low),
                      fmt::format("expected at most {:g} N·m", torque.target));
    if (torque.high < torque.target)
        reader.report(place_of(spec, "max_torque_Nm"),
                      fmt::format("{:g} N·m is below the target", torque.high),
                      fmt::format("expected at least {:g} N·m", torque.target));
    if (spec.known({"snug_torque_Nm"}) && snug_torque >= torque.low && torque.low <= torque.target)
        reader.report(place_of(spec, "snug_torque_Nm"),
                      fmt::format("a snug torque of {:g} N·m is no less than what is judged OK", snug_torque),
                      fmt::format("expected less than {:g} N·m", torque.low));
}

void check_joint_type(const Layers& layers, const JointType& type, double least_share) {
    const joint::JointDesign& design = type.design;
    const Layers spec = layers.inside("spec");
    const bool grip = !design.members.empty() && layers.known({"washer_under_head", "washer_under_nut"}) &&
                      std::all_of(design.members.begin(), design.members.end(),
                                  [](const joint::Member& m) { return m.thickness > 0.0; });
    if (has_size(type) && grip && layers.find("bolt_length_mm")) check_lengths(layers, design);
    if (has_size(type)) check_member_diameter(layers, design);
    if (has_size(type) && has_class(type)) check_clamp(layers, type);
    if (spec.objects().empty()) return;
    const bool torques = spec.find("target_torque_Nm") &&
                         spec.known({"min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"});
    if (has_size(type) && has_class(type) && torques && spec.known({"strategy"}) &&
        layers.known({"friction_thread", "friction_bearing", "prevailing_torque_Nm"}))
        check_load(layers, type);
    check_prevailing(layers, type, least_share);
    check_limits(spec);
    if (torques) check_torques(spec, type.spec.torque, type.spec.snug_torque);
    if (spec.known({"strategy", "target_angle_deg", "min_angle_deg", "max_angle_deg"}))
        check_angles(spec, type.spec);
}

}  // namespace bolt::content
