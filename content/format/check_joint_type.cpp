#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "content/format/read_joints.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::content {

namespace {

constexpr double length_tolerance = 1e-9;  // m; tolerates the rounding of decimal millimetres

bool has_size(const JointType& type) { return type.design.thread.size.d > 0.0; }
bool has_property_class(const JointType& type) { return type.design.bolt_class.R_p02 > 0.0; }

const char* turned_name(const joint::JointDesign& design) {
    return design.turned == joint::TurnedPart::head ? "head" : "nut";
}

// Rounds down to 0.1 N·m, so that the limit in a message is accepted.
double rounded_down(double torque) { return std::floor(torque * 10.0) / 10.0; }

void check_thread_length(const LayeredObject& layers, const joint::JointDesign& design) {
    JsonReader& reader = layers.reader();
    const double grip = design.grip_length();
    const JsonNode thread_node = layers.find("bolt_thread_length_mm");
    if (design.bolt_thread_length > design.bolt_length + length_tolerance) {
        reader.report(
            thread_node.pointer,
            fmt::format("a thread of {:g} mm is longer than its bolt", design.bolt_thread_length / mm),
            fmt::format("at most {:g} mm", design.bolt_length / mm));
        return;
    }
    const double thread = design.thread_on_bolt();
    if (grip < design.bolt_length - thread - length_tolerance)
        reader.report(
            thread_node ? thread_node.pointer : layers.find("bolt_length_mm").pointer,
            fmt::format("the {} cannot reach its seat: the thread ends {:g} mm {}, the grip is {:g} mm",
                        turned_name(design), (design.bolt_length - thread) / mm,
                        design.form == joint::JointForm::stud ? "above the tapped part" : "under the head",
                        grip / mm),
            fmt::format("a shorter bolt, or bolt_thread_length_mm of at least {:g}",
                        (design.bolt_length - grip) / mm));
}

// Checks the screw of a tapped hole; returns false after an error.
bool check_screw_length(const LayeredObject& layers, const joint::JointDesign& design) {
    JsonReader& reader = layers.reader();
    const double grip = design.grip_length(), in_hole = design.bolt_length - grip;
    const double idle = joint::idle_pitches * design.thread.thread.pitch;
    const JsonNode length = layers.find("bolt_length_mm");
    const LayeredObject hole = layers.member_layers("tapped_hole");
    if (in_hole <= idle + length_tolerance) {
        reader.report(length.pointer,
                      fmt::format("a screw of {:g} mm is too short for a grip of {:g} mm and a tapped hole",
                                  design.bolt_length / mm, grip / mm),
                      fmt::format("more than {:g} mm: {:g} pitches of its thread carry nothing",
                                  (grip + idle) / mm, joint::idle_pitches));
        return false;
    }
    const JsonNode engagement = hole.find("engagement_mm");
    if (engagement && design.hole.engagement > in_hole + length_tolerance) {
        reader.report(engagement.pointer,
                      fmt::format("an engagement of {:g} mm, but the screw reaches {:g} mm into the hole",
                                  design.hole.engagement / mm, in_hole / mm),
                      fmt::format("at most {:g} mm", in_hole / mm));
        return false;
    }
    const JsonNode depth = hole.find("depth_mm");
    if (depth && design.hole.depth < in_hole + length_tolerance) {
        reader.report(depth.pointer,
                      fmt::format("the screw meets the bottom of the hole: it reaches {:g} mm into a hole of "
                                  "{:g} mm",
                                  in_hole / mm, design.hole.depth / mm),
                      "a deeper hole, or a shorter screw");
        return false;
    }
    return true;
}

// Reports members that this form of joint cannot have, and those that it lacks.
void check_form(const LayeredObject& layers, const joint::JointDesign& design) {
    using joint::JointForm;
    if (!layers.all_valid({"form", "head", "turned", "counter_hold", "tapped_hole", "locking_insert"}))
        return;
    JsonReader& reader = layers.reader();
    const auto reject = [&](const char* key, const char* what, const char* expected) {
        if (const JsonNode node = layers.find(key)) reader.report(node.pointer, what, expected);
    };
    const bool screw = design.form == JointForm::tapped_hole, stud = design.form == JointForm::stud;
    const auto has = [&](const char* key) { return layers.boolean(key).value_or(false); };
    if (screw && design.turned == joint::TurnedPart::nut)
        reject("turned", "a screw in a tapped hole has no nut", "\"head\"");
    if (stud && design.turned == joint::TurnedPart::head) reject("turned", "a stud has no head", "\"nut\"");
    if (stud && design.head == joint::HeadShape::socket) reject("head", "a stud has no head", "\"hexagon\"");
    if (screw && has("washer_under_nut"))
        reject("washer_under_nut", "a screw in a tapped hole has no nut", "washer_under_head");
    if (stud && has("washer_under_head"))
        reject("washer_under_head", "a stud has no head", "washer_under_nut");
    if (screw && has("locking_insert"))
        reject("locking_insert", "a screw in a tapped hole has no nut", "false");
    if (screw)
        reject("nut_proof_stress_MPa", "a screw in a tapped hole has no nut", "the values of tapped_hole");
    if (design.form != JointForm::through_bolt && design.counter_hold == joint::CounterHold::second_wrench)
        reject("counter_hold", "only a through-bolt has a part for a second wrench", "no such value");
    if (design.head == joint::HeadShape::socket && design.turned == joint::TurnedPart::nut &&
        design.counter_hold == joint::CounterHold::second_wrench)
        reject("counter_hold", "a second wrench cannot hold a socket head", "\"fixed\", or a hexagon head");
    const JsonNode hole = layers.find("tapped_hole");
    if (!design.is_tapped() && hole)
        reader.report(hole.pointer, "a through-bolt has no tapped hole",
                      "the form tapped_hole or stud, or no such value");
    if (design.is_tapped() && !hole)
        reader.report(layers.find("form").pointer, "a joint of this form needs its tapped hole",
                      "tapped_hole with its material");
    const LayeredObject tapped = layers.member_layers("tapped_hole");
    if (stud && hole && !tapped.find("engagement_mm"))
        reader.report(hole.pointer, "a stud needs its engagement",
                      "engagement_mm, of 1 d (DIN 938), 1.25 d (DIN 939) or 2 d (DIN 835)");
    if (const JsonNode depth = tapped.find("depth_mm"))
        if (stud && design.hole.depth < design.hole.engagement)
            reader.report(depth.pointer,
                          fmt::format("a stud with {:g} mm of engagement in a hole of {:g} mm",
                                      design.hole.engagement / mm, design.hole.depth / mm),
                          "a deeper hole");
}

// Reports a size that the tables of socket heads or locking nuts lack. Requires the size.
void check_tables(const LayeredObject& layers, const joint::JointDesign& design) {
    const std::string_view size = design.thread.size.name;
    if (design.head == joint::HeadShape::socket && !joint::socket_head(size))
        layers.reader().report(layers.find("head").pointer,
                               fmt::format("there is no socket head of {} in our table", size),
                               "M5, M6, M8, M10, M12, M16, M20 or M24");
    if (design.locking_insert && !joint::locking_nut(size))
        layers.reader().report(layers.find("locking_insert").pointer,
                               fmt::format("there is no locking nut of {} in our table", size),
                               "M5, M6, M8, M10, M12, M16, M20 or M24");
}

// Reports a tapped thread that strips before the highest torque that is judged OK. Requires the size, the
// class, the friction, the target torque and the complete grip.
void check_stripping(const LayeredObject& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    const joint::TappedHole& hole = design.hole;
    if (!design.is_tapped() || hole.material.R_m <= 0.0 || hole.engagement <= 0.0) return;
    const joint::ScrewThread& thread = design.thread.thread;
    const double strip =
        joint::stripping_forces(thread, design.bolt_class, hole.material, hole.engagement).least();
    const double clamp = (type.spec.torque.high - design.prevailing_torque) /
                         joint::torque_levers(thread, design.friction.thread, design.friction.bearing,
                                              design.bearing_diameter())
                             .tightening_lever();
    if (strip >= clamp) return;
    const JsonNode engagement = layers.member_layers("tapped_hole").find("engagement_mm");
    const double share = clamp / (design.bolt_class.R_m * thread.A_s);
    layers.reader().report(
        (engagement ? engagement : layers.find("bolt_length_mm")).pointer,
        fmt::format(
            "the thread in {} strips at {:.1f} kN with {:g} mm of engagement, and {:g} N·m clamps with "
            "{:.1f} kN",
            hole.material.name, strip * 1e-3, hole.engagement / mm, type.spec.torque.high, clamp * 1e-3),
        fmt::format(
            "an engagement of at least {:.1f} mm",
            std::ceil(joint::needed_engagement(thread, design.bolt_class, hole.material, share) / mm * 10.0) /
                10.0));
}

// Requires a bolt that is long enough.
void check_thread_and_gap(const LayeredObject& layers, const joint::JointDesign& design) {
    JsonReader& reader = layers.reader();
    if (layers.all_valid({"bolt_thread_length_mm"})) check_thread_length(layers, design);
    const JsonNode gap = layers.find("start_gap_mm");
    if (gap && design.start_gap > design.bolt_length - design.grip_length() + length_tolerance)
        reader.report(gap.pointer,
                      fmt::format("a gap of {:g} mm is beyond the bolt's end", design.start_gap / mm),
                      fmt::format("less than {:g} mm", (design.bolt_length - design.grip_length()) / mm));
}

// Requires the size, the bolt's length and the complete grip. Returns false after an error.
bool check_lengths(const LayeredObject& layers, const joint::JointDesign& design) {
    JsonReader& reader = layers.reader();
    const double grip = design.grip_length();
    if (design.form == joint::JointForm::tapped_hole) {
        if (!check_screw_length(layers, design)) return false;
        check_thread_and_gap(layers, design);
        return true;
    }
    const double nut = joint::nut_height(design), needed = grip + nut + design.thread.thread.pitch;
    if (design.bolt_length < needed - length_tolerance) {
        reader.report(layers.find("bolt_length_mm").pointer,
                      fmt::format("a bolt of {:g} mm is too short for a grip of {:g} mm and a nut of {:g} mm",
                                  design.bolt_length / mm, grip / mm, nut / mm),
                      fmt::format("at least {:g} mm", needed / mm));
        return false;
    }
    check_thread_and_gap(layers, design);
    return true;
}

void check_member_diameter(const LayeredObject& layers, const joint::JointDesign& design) {
    const JsonNode diameter = layers.find("member_diameter_mm");
    const double bearing = joint::turned_part_size(design).bearing;
    if (diameter && design.member_diameter < bearing)
        layers.reader().report(
            diameter.pointer,
            fmt::format("members of {:g} mm diameter are smaller than the {}'s bearing face",
                        design.member_diameter / mm, turned_name(design)),
            fmt::format("at least {:g} mm", bearing / mm));
}

void check_clamp(const LayeredObject& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    const double strength = design.bolt_class.R_m * design.thread.thread.A_s;
    if (type.spec.target_clamp > strength)
        layers.reader().report(layers.member_layers("spec").find("target_clamp_kN").pointer,
                               fmt::format("{:g} kN breaks {} of class {}", type.spec.target_clamp * 1e-3,
                                           joint::name(design.thread), design.bolt_class.name),
                               fmt::format("less than {:.1f} kN", strength * 1e-3));
}

// Reports a joint that is tightened to yield although the highest torque that is judged OK is below yield:
// every trainee who follows the instruction exceeds it.
void report_early_end(const LayeredObject& layers, const JointType& type, double yield_torque) {
    const joint::JointDesign& design = type.design;
    layers.reader().report(
        layers.member_layers("spec").find("strategy").pointer,
        fmt::format("the highest torque that is judged OK, {:g} N·m, is below yield: {} of class {} with "
                    "friction {:g} and {:g} yields near {:.1f} N·m",
                    type.spec.torque.high, joint::name(design.thread), design.bolt_class.name,
                    design.friction.thread, design.friction.bearing, yield_torque),
        fmt::format(
            "the strategy \"torque\", or a highest torque above {:.1f} N·m (target_torque_Nm with its "
            "tolerance, or max_torque_Nm)",
            yield_torque));
}

// Requires the size, the class, the friction and the target torque.
void check_load(const LayeredObject& layers, const JointType& type) {
    const joint::JointDesign& design = type.design;
    constexpr double utilisation = 0.9;
    const double torque_90 =
        joint::assembly_preload(design.thread.thread, design.bolt_class, design.friction.thread,
                                design.friction.bearing, design.bearing_diameter(), utilisation)
            .torque;
    const double yield_torque = torque_90 / utilisation + design.prevailing_torque;
    const LayeredObject spec = layers.member_layers("spec");
    const JsonNode target = spec.find("target_torque_Nm"), limit = spec.find("max_torque_Nm");
    const auto report_torque = [&](const JsonNode& at, double torque, const char* torque_suffix,
                                   double max_torque, const char* limit_suffix) {
        layers.reader().report(
            at.pointer,
            fmt::format("{:g} N·m{} is too much for {} of class {} with friction {:g} and {:g}: it yields "
                        "near {:.1f} N·m",
                        torque, torque_suffix, joint::name(design.thread), design.bolt_class.name,
                        design.friction.thread, design.friction.bearing, rounded_down(yield_torque)),
            fmt::format("at most {:.1f} N·m{}", rounded_down(max_torque), limit_suffix));
    };
    const ToleranceWindow& torque = type.spec.torque;
    if (type.spec.strategy != Strategy::torque) {
        // An angle may lead beyond yield, too. There a bolt hardens by less than 30 %; a higher target breaks
        // it or has a misplaced decimal point.
        const double max_torque = 1.3 * torque_90 + design.prevailing_torque;
        if (torque.target > max_torque)
            report_torque(target, torque.target, "", max_torque, "");
        else if (type.spec.strategy == Strategy::yield && torque.high < yield_torque)
            report_early_end(layers, type, yield_torque);
    } else if (torque.high > yield_torque) {
        const bool limited = limit && layers.reader().number(limit) == torque.high;
        const char* limit_suffix = limited ? "" : " with its tolerance";
        if (torque.target > yield_torque)
            report_torque(target, torque.target, "", yield_torque, limit_suffix);
        else
            report_torque(limited ? limit : target, torque.high,
                          limited ? "" : " (the target with its tolerance)", yield_torque, limit_suffix);
    }
}

// Reports a prevailing torque that is unusually large, or that leaves no torque to load the bolt.
void check_prevailing(const LayeredObject& layers, const JointType& type, double smallest_pass_fraction) {
    constexpr double margin = 1.5;  // factor on ISO 2320, for other classes, coatings and dry threads
    const JsonNode given = layers.find("prevailing_torque_Nm");
    const JsonNode node = given ? given : layers.find("locking_insert");
    const double prevailing = type.design.prevailing_torque, target = type.spec.torque.target;
    if (!node || prevailing <= 0.0) return;
    const bool target_known = static_cast<bool>(layers.member_layers("spec").find("target_torque_Nm"));
    const double pass_torque =
        target_known ? smallest_pass_fraction * target : std::numeric_limits<double>::infinity();
    const joint::LockingNut* const nut = joint::locking_nut(type.design.thread.size.name);
    const double iso_torque = nut ? nut->most_on : 0.0;  // 0: unknown
    const double max_torque =
        iso_torque > 0.0 ? margin * iso_torque : std::numeric_limits<double>::infinity();
    if (prevailing >= pass_torque)
        layers.reader().report(
            node.pointer,
            fmt::format("a nut that takes {:g} N·m to turn never loads its bolt in a pass that tightens to "
                        "{:g} N·m ({:g} percent of {:g})",
                        prevailing, pass_torque, smallest_pass_fraction * 100.0, target),
            max_torque < pass_torque
                ? fmt::format("at most {:g} N·m", max_torque)
                : fmt::format("less than {:g} N·m{}", pass_torque,
                              smallest_pass_fraction < 1.0 ? ", or a higher percentage" : ""));
    else if (prevailing > max_torque)
        layers.reader().report(node.pointer,
                               fmt::format("{:g} N·m is too much for a locking nut {}: ISO 2320 allows {:g} "
                                           "N·m (class 8, first assembly)",
                                           prevailing, type.design.thread.size.name, iso_torque),
                               fmt::format("at most {:g} N·m", max_torque));
}

std::string pointer_of(const LayeredObject& spec, const char* key) {
    const JsonNode node = spec.find(key);
    return node ? node.pointer : spec.objects().front().pointer;
}

}  // namespace

void check_limits(const LayeredObject& spec) {
    JsonReader& reader = spec.reader();
    const auto check_pair = [&](const char* low, const char* high) {
        const JsonNode low_node = spec.find(low), high_node = spec.find(high);
        const auto report_single = [&](const JsonNode& node, const char* here, const char* other) {
            reader.report(node.pointer, fmt::format("\"{}\" without \"{}\"", here, other), "both or neither",
                          JsonPart::key);
        };
        if (!spec.all_valid({low, high})) return;
        if (low_node && !high_node) report_single(low_node, low, high);
        if (high_node && !low_node) report_single(high_node, high, low);
    };
    check_pair("min_torque_Nm", "max_torque_Nm");
    check_pair("min_angle_deg", "max_angle_deg");
    for (const JsonNode& object : spec.objects()) {
        const LayeredObject layer(reader, {object});
        const JsonNode tolerance = layer.find("torque_tolerance_percent");
        if (tolerance && (layer.find("min_torque_Nm") || layer.find("max_torque_Nm")))
            reader.report(tolerance.pointer, "both a tolerance and limits of the torque", "one or the other",
                          JsonPart::key);
    }
}

void check_torques(const LayeredObject& spec, const ToleranceWindow& torque, double snug_torque) {
    JsonReader& reader = spec.reader();
    if (torque.low > torque.target)
        reader.report(pointer_of(spec, "min_torque_Nm"),
                      fmt::format("{:g} N·m is above the target", torque.low),
                      fmt::format("at most {:g} N·m", torque.target));
    if (torque.high < torque.target)
        reader.report(pointer_of(spec, "max_torque_Nm"),
                      fmt::format("{:g} N·m is below the target", torque.high),
                      fmt::format("at least {:g} N·m", torque.target));
    if (spec.all_valid({"snug_torque_Nm"}) && snug_torque >= torque.low && torque.low <= torque.target)
        reader.report(
            pointer_of(spec, "snug_torque_Nm"),
            fmt::format("a snug torque of {:g} N·m is not below the lowest torque that is judged OK",
                        snug_torque),
            fmt::format("less than {:g} N·m", torque.low));
}

void check_angles(const LayeredObject& spec, const Specification& s) {
    JsonReader& reader = spec.reader();
    if (s.has_angle) {
        const double target = to_degrees(s.angle.target);
        if (s.angle.low > s.angle.high)
            reader.report(pointer_of(spec, "min_angle_deg"),
                          fmt::format("{:g} degrees is above the largest angle", to_degrees(s.angle.low)),
                          fmt::format("at most {:g}", to_degrees(s.angle.high)));
        else if (target < to_degrees(s.angle.low) - 1e-9 || target > to_degrees(s.angle.high) + 1e-9)
            reader.report(pointer_of(spec, "target_angle_deg"),
                          fmt::format("{:g} degrees is outside its window", target),
                          fmt::format("{:g} to {:g}", to_degrees(s.angle.low), to_degrees(s.angle.high)));
    } else if (s.strategy == Strategy::torque_angle) {
        reader.report(pointer_of(spec, "strategy"), "the strategy torque_angle needs an angle",
                      "min_angle_deg and max_angle_deg, and target_angle_deg where it is not their middle");
    } else if (const JsonNode target = spec.find("target_angle_deg")) {
        reader.report(target.pointer, "a target angle without a window",
                      "min_angle_deg and max_angle_deg too");
    }
}

void check_joint_type(const LayeredObject& layers, const JointType& type, double smallest_pass_fraction) {
    const joint::JointDesign& design = type.design;
    const LayeredObject spec = layers.member_layers("spec");
    const bool grip = !design.members.empty() &&
                      layers.all_valid({"washer_under_head", "washer_under_nut"}) &&
                      std::all_of(design.members.begin(), design.members.end(),
                                  [](const joint::Member& m) { return m.thickness > 0.0; });
    check_form(layers, design);
    if (has_size(type)) check_tables(layers, design);
    const bool lengths =
        has_size(type) && grip && layers.find("bolt_length_mm") && layers.all_valid({"form", "tapped_hole"});
    const bool long_enough = lengths && check_lengths(layers, design);
    if (has_size(type)) check_member_diameter(layers, design);
    if (has_size(type) && has_property_class(type)) check_clamp(layers, type);
    if (spec.objects().empty()) return;
    const bool torques = spec.find("target_torque_Nm") &&
                         spec.all_valid({"min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"});
    if (has_size(type) && has_property_class(type) && torques && spec.all_valid({"strategy"}) &&
        layers.all_valid({"friction_thread", "friction_bearing", "prevailing_torque_Nm"}))
        check_load(layers, type);
    if (long_enough && has_property_class(type) && torques &&
        layers.all_valid({"friction_thread", "friction_bearing", "prevailing_torque_Nm"}))
        check_stripping(layers, type);
    check_prevailing(layers, type, smallest_pass_fraction);
    check_limits(spec);
    if (torques) check_torques(spec, type.spec.torque, type.spec.snug_torque);
    if (spec.all_valid({"strategy", "target_angle_deg", "min_angle_deg", "max_angle_deg"}))
        check_angles(spec, type.spec);
}

}  // namespace bolt::content
