#include "content/format/read_joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "content/format/json_document.hpp"
#include "content/format/json_syntax.hpp"
#include "content/format/read_assembly.hpp"

namespace bolt::content {

namespace {

// Converts a spelling such as "m 12 × 1,75" to the form of parse_thread, "M12x1.75".
std::string normalised(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, char>, 9> replacements = {
        {{"\u00D7", 'x'},  // ×
         {"X", 'x'},
         {"*", 'x'},
         {",", '.'},
         {"m", 'M'},
         {"\u00A0", ' '},  // no-break space
         {"\u2009", ' '},  // thin
         {"\u202F", ' '},  // narrow no-break
         {"\t", ' '}}};
    std::string result;
    bool space_skipped = false;
    while (!text.empty()) {
        const auto* const replacement =
            std::find_if(replacements.begin(), replacements.end(),
                         [&](const auto& w) { return text.starts_with(w.first); });
        const char c = replacement != replacements.end() ? replacement->second : text.front();
        text.remove_prefix(replacement != replacements.end() ? replacement->first.size() : 1);
        if (c == ' ') {
            space_skipped = true;
            continue;
        }
        // Two numbers separated by a space must not become one.
        if (space_skipped && is_digit(c) && !result.empty() && is_digit(result.back())) result += 'x';
        space_skipped = false;
        result += c;
    }
    return result;
}

// The first number of a text, which is the diameter.
std::string_view first_number(std::string_view text) {
    const auto in_number = [](char c) { return is_digit(c) || c == '.'; };
    const auto* const begin = std::find_if(text.begin(), text.end(), is_digit);
    const auto* const end = std::find_if_not(begin, text.end(), in_number);
    return {begin, end};
}

// The size in a standard designation of a left-hand thread, such as M12x1.75-LH (ISO 965-1), in its
// normalised spelling; none if it is not such a designation.
std::optional<std::string> size_of_left_hand(std::string_view normal_text) {
    for (const std::string_view suffix : {"-LH", "LH", "-lh", "lh"})
        if (normal_text.ends_with(suffix)) {
            normal_text.remove_suffix(suffix.size());
            if (joint::parse_thread(normal_text)) return std::string(normal_text);
            return std::nullopt;
        }
    return std::nullopt;
}

}  // namespace

Result<joint::ThreadSize> read_thread(std::string_view text) {
    auto thread = joint::parse_thread(text);
    if (thread) return thread;
    const std::string normal_text = normalised(text);
    const auto normal_thread = joint::parse_thread(normal_text);
    std::string what = fmt::format("{} is not a known thread", in_quotes(text));
    if (normal_thread)
        return fail(ErrorCode::bad_content, std::move(what),
                    fmt::format("did you mean \"{}\"?", normal_text));
    if (const auto size = size_of_left_hand(normal_text))
        return fail(ErrorCode::bad_content, std::move(what),
                    fmt::format("\"size\": \"{}\" and \"thread_direction\": \"left\"", *size));
    const auto sizes = joint::fastener_sizes();
    const std::string_view name = std::string_view(normal_text).substr(0, normal_text.find('x'));
    if (std::any_of(sizes.begin(), sizes.end(), [&](const auto& size) { return size.name == name; }))
        return fail(ErrorCode::bad_content, std::move(what),
                    normal_thread.error().expected);  // lists the pitches of this size
    std::vector<std::string> same_diameter;
    for (std::string& known : joint::thread_names())
        if (first_number(known) == first_number(normal_text)) same_diameter.push_back(std::move(known));
    const std::string best = nearest_name(normal_text, same_diameter);
    return fail(ErrorCode::bad_content, fmt::format("{} is not a known thread size", in_quotes(text)),
                best.empty() ? joint::describe_threads() : fmt::format("did you mean {}?", in_quotes(best)));
}

namespace {

constexpr double default_tolerance = 0.10;  // of the target torque
constexpr double default_snug = 0.25;       // of the target torque
constexpr double started_turns = 1.5;       // turns of a hand-started nut on the thread

std::vector<joint::Member> read_members(const LayeredObject& layers, const YoungsModuli& moduli) {
    JsonReader& reader = layers.reader();
    std::vector<joint::Member> members;
    std::vector<std::string> names;
    for (const auto& [name, E] : moduli.E) names.push_back(name);
    for (const JsonNode& node : reader.items(layers.find("members"))) {
        joint::Member member;
        member.thickness = reader.number(reader.member(node, "thickness_mm")).value_or(0.0) * mm;
        const JsonNode material = reader.member(node, "material");
        const auto name = reader.text(material);
        if (name && moduli.E.contains(*name)) {
            member.E = moduli.E.at(*name);
        } else if (name && moduli.materials_are_valid) {
            reader.report(
                material.pointer, fmt::format("{} is not a material of this file", in_quotes(*name)),
                nearest_name(*name, names).empty() ? suggest(*name, names) + ", or add it to \"materials\""
                                                   : suggest(*name, names));
        }
        members.push_back(member);
    }
    return members;
}

joint::FrictionDesign read_friction(const LayeredObject& layers) {
    joint::FrictionDesign friction;
    friction.thread = layers.number("friction_thread").value_or(friction.thread);
    friction.bearing = layers.number("friction_bearing").value_or(friction.bearing);
    friction.static_ratio = layers.number("friction_static_ratio").value_or(friction.static_ratio);
    if (const auto held = layers.number("friction_held_bearing")) friction.held_bearing = *held;
    friction.scatter = layers.number("friction_scatter_percent").value_or(friction.scatter * 100.0) / 100.0;
    const std::string lubrication = layers.text("lubrication").value_or("as_received");
    using joint::Lubrication;
    friction.lubrication = lubrication == "dry"     ? Lubrication::dry
                           : lubrication == "oiled" ? Lubrication::oiled
                           : lubrication == "mos2"  ? Lubrication::mos2
                                                    : Lubrication::as_received;
    return friction;
}

joint::JointDesign read_design(const LayeredObject& layers, const YoungsModuli& moduli) {
    JsonReader& reader = layers.reader();
    joint::JointDesign design{};
    read_form(layers, design);
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
    design.members = read_members(layers, moduli);
    design.member_diameter = layers.number("member_diameter_mm").value_or(0.0) * mm;
    design.friction = read_friction(layers);
    design.roughness_Rz = layers.number("roughness_Rz_um").value_or(design.roughness_Rz / um) * um;
    design.misfit = layers.number("misfit_um").value_or(design.misfit / um) * um;
    design.embedding_time = layers.number("embedding_time_s").value_or(design.embedding_time);
    design.prevailing_torque =
        layers.number("prevailing_torque_Nm").value_or(usual_prevailing_torque(design));
    design.running_drag = layers.number("running_torque_Nm").value_or(design.running_drag);
    design.nut_mass = layers.number("nut_mass_g").value_or(0.0) * 1e-3;
    const double started =
        design.bolt_length - design.grip_length() - started_turns * design.thread.thread.pitch;
    design.start_gap = layers.number("start_gap_mm").value_or(std::max(started, 0.0) / mm) * mm;
    if (design.form == joint::JointForm::tapped_hole && design.hole.engagement <= 0.0)
        design.hole.engagement = std::max(0.0, design.bolt_length - design.grip_length());
    return design;
}

// Limits and a tolerance are alternatives; the topmost layer that has one of them decides.
ToleranceWindow read_torque(const LayeredObject& spec) {
    ToleranceWindow torque;
    torque.target = spec.number("target_torque_Nm").value_or(0.0);
    torque.low = torque.target * (1.0 - default_tolerance);
    torque.high = torque.target * (1.0 + default_tolerance);
    for (const JsonNode& object : spec.objects()) {
        const LayeredObject layer(spec.reader(), {object});
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

double read_snug_torque(const LayeredObject& spec, const ToleranceWindow& torque) {
    return spec.number("snug_torque_Nm").value_or(default_snug * torque.target);
}

}  // namespace

Specification read_spec(const LayeredObject& spec) {
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

YoungsModuli read_youngs_moduli(JsonReader& reader) {
    YoungsModuli moduli;
    moduli.E = {{"aluminium", 70e9},     {"bronze", 105e9},          {"cast_iron", 110e9},
                {"ductile_iron", 170e9}, {"stainless_steel", 200e9}, {"steel", 205e9}};
    const JsonNode own = reader.member(reader.root(), "materials");
    moduli.materials_are_valid = reader.is_valid(own.pointer);
    for (const JsonNode& node : reader.items(own))
        if (const auto E = reader.number(reader.member(node, "E_GPa")))
            moduli.E[last_token(node.pointer)] = *E * 1e9;
    return moduli;
}

JointType read_joint_type(const LayeredObject& layers, const YoungsModuli& moduli,
                          double smallest_pass_fraction) {
    JsonReader& reader = layers.reader();
    std::vector<JsonNode> laws;
    for (const JsonNode& layer : layers.objects()) laws.push_back(reader.member(layer, "published"));
    laws.push_back(reader.member(reader.root(), "published"));
    const JointType type{read_design(layers, moduli), read_spec(layers.member_layers("spec")),
                         read_published(LayeredObject(reader, std::move(laws))),
                         layers.text("tool").value_or("")};
    check_joint_type(layers, type, smallest_pass_fraction);
    return type;
}

namespace {

std::vector<std::string> names_of(const JsonReader& reader, const JsonNode& object) {
    std::vector<std::string> names;
    for (const JsonNode& node : reader.items(object)) names.push_back(last_token(node.pointer));
    return names;
}

void report_unknown(JsonReader& reader, std::string_view pointer, JsonPart part, std::string_view kind,
                    std::string_view name, const std::vector<std::string>& known) {
    reader.report(pointer, fmt::format("{} is not a {}", in_quotes(name), kind), suggest(name, known), part);
}

struct JointTypes {
    JsonReader& reader;
    bool patched;          // a variant's patches apply
    JsonNode all;          // "joint_types"
    JsonNode every_patch;  // of the variant
    JsonNode patches;      // of the variant, by type
    YoungsModuli moduli;
    double smallest_pass_fraction;  // smallest fraction of the target torque of all passes
    // Types of the joints that the variant leaves out. Neither its patches nor its passes concern them.
    std::set<std::string, std::less<>> unused;
    std::map<std::string, JointType> read;

    LayeredObject layers(const std::string& name) {
        if (!patched || unused.contains(name)) return {reader, {reader.member(all, name)}};
        return {reader, {reader.member(patches, name), every_patch, reader.member(all, name)}};
    }
    [[nodiscard]] double smallest_fraction(const std::string& name) const {
        return unused.contains(name) ? 1.0 : smallest_pass_fraction;
    }
};

// The types of which a variant that names its joints names none.
std::set<std::string, std::less<>> unused_types(JsonReader& reader, const std::string& variant) {
    const JsonNode selection = variant_joint_list(reader, variant);
    std::set<std::string, std::less<>> ids, used, unused;
    for (const JsonNode& id : reader.items(selection)) ids.insert(reader.text(id).value_or(""));
    if (!selection) return unused;
    const std::vector<JsonNode> joints = reader.items(reader.member(reader.root(), "joints"));
    const auto type_of = [&](const JsonNode& joint) {
        return reader.text(reader.member(joint, "type")).value_or("");
    };
    for (const JsonNode& joint : joints)
        if (ids.contains(reader.text(reader.member(joint, "id")).value_or(""))) used.insert(type_of(joint));
    for (const JsonNode& joint : joints)
        if (!used.contains(type_of(joint))) unused.insert(type_of(joint));
    return unused;
}

Vec3 read_axis(JsonReader& reader, const JsonNode& joint) {
    const JsonNode node = reader.member(joint, "axis");
    const Vec3 axis = reader.vector(node).value_or(Vec3{0.0, 1.0, 0.0});
    const double length = std::sqrt(glm::dot(axis, axis));
    if (std::abs(length - 1.0) > 0.001) {
        reader.report(
            node.pointer,
            length < 1e-6 ? "the axis has no length" : fmt::format("the axis has the length {:.4g}", length),
            "a unit vector, as in [0, 1, 0]");
        return {0.0, 1.0, 0.0};
    }
    return axis / length;
}

AssemblyJoint read_joint(JointTypes& types, const JsonNode& node) {
    JsonReader& reader = types.reader;
    AssemblyJoint joint{};
    joint.type = reader.text(reader.member(node, "type")).value_or("");
    joint.node = reader.text(reader.member(node, "node")).value_or("");
    const JsonNode override = reader.member(node, "override");
    if (types.read.contains(joint.type)) {
        JointType type = types.read.at(joint.type);
        if (override) {
            std::vector<JsonNode> objects = types.layers(joint.type).objects();
            objects.insert(objects.begin(), override);
            type = read_joint_type(LayeredObject(reader, std::move(objects)), types.moduli,
                                   types.smallest_fraction(joint.type));
        }
        joint.design = std::move(type.design);
        joint.spec = type.spec;
        joint.published = type.published;
        joint.tool = type.tool;
    }
    joint.design.id = reader.text(reader.member(node, "id")).value_or("");
    joint.design.axis = read_axis(reader, node);
    joint.design.seat = reader.vector(reader.member(node, "position_mm")).value_or(Vec3{0.0}) * mm +
                        joint.design.washer_under_turned() * joint.design.axis;
    return joint;
}

}  // namespace

std::vector<AssemblyJoint> read_joints(JsonReader& reader, const std::string& variant) {
    const JsonNode root = reader.root();
    const JsonNode patch =
        variant.empty() ? JsonNode{} : reader.member(reader.member(root, "variants"), variant);
    JointTypes types{reader,
                     !variant.empty(),
                     reader.member(root, "joint_types"),
                     reader.member(patch, "every_joint_type"),
                     reader.member(patch, "joint_types"),
                     read_youngs_moduli(reader),
                     smallest_pass_fraction(reader, variant),
                     unused_types(reader, variant),
                     {}};
    const std::vector<std::string> type_names = names_of(reader, types.all);
    const bool has_types = static_cast<bool>(types.all);
    for (const std::string& name : type_names)
        types.read.emplace(name,
                           read_joint_type(types.layers(name), types.moduli, types.smallest_fraction(name)));
    for (const JsonNode& node : reader.items(types.patches))
        if (has_types && !types.read.contains(last_token(node.pointer)))
            report_unknown(reader, node.pointer, JsonPart::key, "joint type of this file",
                           last_token(node.pointer), type_names);

    const std::vector<JsonNode> nodes = reader.items(reader.member(root, "joints"));
    std::vector<AssemblyJoint> joints;
    for (const JsonNode& node : nodes) {
        joints.push_back(read_joint(types, node));
        joints.back().index_in_file = joints.size() - 1;
        const JsonNode type = reader.member(node, "type");
        if (type && has_types && !types.read.contains(joints.back().type))
            report_unknown(reader, type.pointer, JsonPart::value, "joint type of this file",
                           joints.back().type, type_names);
    }
    check_joints(reader, nodes, joints);
    return joints;
}

}  // namespace bolt::content
