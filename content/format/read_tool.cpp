// Reads the tools of an assembly: kind, sizes, and whether they fit the parts that they are to turn.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <set>
#include <utility>

#include "content/format/json_document.hpp"
#include "content/format/read_assembly.hpp"
#include "haptics/joint/nut.hpp"

namespace bolt::content {

namespace {

constexpr double max_jaw_play = 0.6e-3;  // m, of a jaw on a nut
constexpr double default_head_angle = to_radians(15.0);
constexpr double default_click_swing_deg = 4.0;
constexpr double default_accuracy_percent = 4.0;  // ISO 6789-1: type II, class A, above 10 N·m
constexpr double shortest_lever_mm = 100.0;       // from the adaptor to the grip
constexpr double default_teeth = 72.0;
constexpr std::array ratchets{24.0, 72.0, 90.0};

struct KindRow {
    std::string_view name;
    ToolKind kind;
    ToolHeadKind head;  // its own, or the default one of a tool with a choice
};
constexpr std::array kinds{
    KindRow{"open_end_wrench", ToolKind::open_end_wrench, ToolHeadKind::open_end},
    KindRow{"ring_wrench", ToolKind::ring_wrench, ToolHeadKind::ring},
    KindRow{"hex_key", ToolKind::hex_key, ToolHeadKind::hex_key},
    KindRow{"ratchet", ToolKind::ratchet, ToolHeadKind::socket},
    KindRow{"click_torque_wrench", ToolKind::click_torque_wrench, ToolHeadKind::open_end},
    KindRow{"electronic_torque_wrench", ToolKind::electronic_torque_wrench, ToolHeadKind::open_end},
};

struct HeadRow {
    std::string_view name;  // in the file; empty: not a choice
    ToolHeadKind head;
    std::string_view title;  // in messages
};
constexpr std::array heads{
    HeadRow{"open_end", ToolHeadKind::open_end, "an open end"}, HeadRow{"", ToolHeadKind::ring, "a ring"},
    HeadRow{"socket", ToolHeadKind::socket, "a socket"}, HeadRow{"", ToolHeadKind::hex_key, "a hexagon key"},
    HeadRow{"hex_bit", ToolHeadKind::hex_bit, "a hexagon bit"}};

std::string_view title_of(ToolHeadKind head) {
    return std::find_if(heads.begin(), heads.end(), [&](const HeadRow& row) { return row.head == head; })
        ->title;
}

bool has_drive(const WrenchDesign& wrench) {
    return wrench.head == ToolHeadKind::socket || wrench.head == ToolHeadKind::hex_bit;
}

// Reports each of these members that the tool has.
void refuse(JsonReader& reader, const LayeredObject& tool, std::initializer_list<std::string_view> keys,
            const std::string& what, const std::string& expected) {
    if (!tool.all_valid({"kind", "head"})) return;
    for (const std::string_view key : keys)
        if (const JsonNode node = tool.find(key); node.value != nullptr)
            reader.report(node.pointer, what, expected);
}

void read_kind(JsonReader& reader, const LayeredObject& tool, WrenchDesign& wrench) {
    const auto kind = tool.text("kind"), head = tool.text("head");
    for (const KindRow& row : kinds)
        if (kind && *kind == row.name) {
            wrench.kind = row.kind;
            wrench.head = row.head;
        }
    if (!head || !kind) return;
    const bool measures = is_torque_wrench(wrench.kind);
    if (!measures && wrench.kind != ToolKind::ratchet) {
        reader.report(head.pointer, fmt::format("{} has no choice of heads", in_quotes(*kind)),
                      "no \"head\"");
        return;
    }
    for (const HeadRow& row : heads)
        if (*head == row.name) wrench.head = row.head;
    if (!measures && wrench.head == ToolHeadKind::open_end)
        reader.report(head.pointer, "a ratchet does not turn an open end", "\"socket\" or \"hex_bit\"");
}

// Reads the adaptor between a torque wrench and its open end. `wrench.handle_length` includes it.
void read_adaptor(JsonReader& reader, const LayeredObject& tool, WrenchDesign& wrench) {
    const auto adaptor = tool.number("adaptor_mm");
    if (!adaptor) return;
    if (!tool.all_valid({"kind", "head"})) return;
    if (!is_torque_wrench(wrench.kind) || wrench.head != ToolHeadKind::open_end) {
        reader.report(adaptor.pointer, "the adaptor lengthens only a torque wrench with an open end",
                      "the head \"open_end\", or no \"adaptor_mm\"");
        return;
    }
    const auto handle = tool.number("handle_length_mm");
    if (handle && *handle - *adaptor < shortest_lever_mm)
        reader.report(
            adaptor.pointer,
            fmt::format("an adaptor of {:g} mm leaves a lever of {:g} mm", *adaptor, *handle - *adaptor),
            fmt::format("at most {:g} mm, the handle length less {:g} mm", *handle - shortest_lever_mm,
                        shortest_lever_mm));
    else
        wrench.adaptor_length = *adaptor * mm;
}

// Reads the members of a click-type torque wrench. On another tool they are an error.
void read_click(JsonReader& reader, const LayeredObject& tool, WrenchDesign& wrench) {
    if (wrench.kind != ToolKind::click_torque_wrench) {
        refuse(reader, tool, {"click_swing_deg", "accuracy_percent"}, "only a torque wrench clicks",
               "the kind \"click_torque_wrench\", or no such value");
        return;
    }
    wrench.click_swing = to_radians(tool.number("click_swing_deg").value_or(default_click_swing_deg));
    wrench.click_accuracy = tool.number("accuracy_percent").value_or(default_accuracy_percent) / 100.0;
}

// Reads ratchet and extension bar, which only tools with a square drive have.
void read_drive(JsonReader& reader, const LayeredObject& tool, WrenchDesign& wrench) {
    const auto teeth = tool.number("teeth"), extension = tool.number("extension_mm");
    if (!has_drive(wrench)) {
        refuse(reader, tool, {"teeth", "extension_mm"},
               fmt::format("{} has no square drive", title_of(wrench.head)),
               "a ratchet, or a torque wrench with a socket or a bit");
        return;
    }
    wrench.teeth = static_cast<int>(teeth.value_or(default_teeth));
    if (teeth && std::find(ratchets.begin(), ratchets.end(), *teeth) == ratchets.end())
        reader.report(teeth.pointer, fmt::format("a ratchet of {:g} teeth is unknown", *teeth),
                      "24, 72 or 90");
    wrench.extension = extension.value_or(0.0) * mm;
}

bool grips_inside(const WrenchDesign& wrench) {
    return wrench.head == ToolHeadKind::hex_key || wrench.head == ToolHeadKind::hex_bit;
}

// m, by which the tool may be wider than the part.
double most_play(const WrenchDesign& wrench) {
    return wrench.head == ToolHeadKind::open_end ? max_jaw_play : 0.0;
}

// `width`: m, of the tool. `s`: m, across flats of the part.
bool has_width(const WrenchDesign& wrench, double width, double s) {
    return width > s - 1e-9 && width < s + most_play(wrench) + 1e-9;
}

bool suits_any(const WrenchDesign& wrench, const std::vector<AssemblyJoint>& joints) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const AssemblyJoint& joint) { return suits(wrench, joint.design); });
}

// Reports a tool, once, if a part of `joints` that its kind can grip has another size. `remedy`: appended to
// the expected size; may be empty.
void check_fit(JsonReader& reader, const Located<double>& given, const WrenchDesign& wrench,
               const std::vector<AssemblyJoint>& joints, const std::string& remedy) {
    const bool inside = grips_inside(wrench);
    const double width = *given * mm;
    const double play = most_play(wrench);
    const std::string name =
        wrench.head == ToolHeadKind::open_end ? std::string("a jaw") : std::string(title_of(wrench.head));
    for (const AssemblyJoint& joint : joints) {
        const joint::TurnedPartSize part = joint::turned_part_size(joint.design);
        const double s = part.across_flats;
        if ((part.depth > 0.0) != inside || s <= 0.0) continue;
        if (has_width(wrench, width, s)) continue;
        reader.report(given.pointer,
                      fmt::format("{} of {:g} mm does not fit {}, {:g} mm across flats", name, *given,
                                  joint.design.thread.size.name, s / mm),
                      (play > 0.0 ? fmt::format("{:g} to {:g} mm", s / mm, (s + play) / mm)
                                  : fmt::format("{:g} mm", s / mm)) +
                          remedy);
        break;
    }
}

// The bottom of the jaw must leave room for a corner, and its tips must reach beyond the ends of the flats.
void check_jaw_room(JsonReader& reader, const LayeredObject& tool, const std::vector<AssemblyJoint>& joints) {
    double widest = 0.0;
    for (const AssemblyJoint& joint : joints)
        if (const auto part = joint::turned_part_size(joint.design); part.depth <= 0.0)
            widest = std::max(widest, part.across_flats);
    const auto too_short = [&](const auto& value, double share, const char* what) {
        if (!value || *value * mm >= share * widest - 1e-9) return;
        reader.report(
            value.pointer,
            fmt::format("{} of {:g} mm is too short for {:g} mm across flats", what, *value, widest / mm),
            fmt::format("at least {:.2f} mm", share * widest / mm));
    };
    too_short(tool.number("jaw_depth_mm"), 1.0 / std::sqrt(3.0), "a jaw depth");
    too_short(tool.number("jaw_tip_mm"), 1.0 / std::sqrt(12.0), "a jaw tip");
}

void read_open_end(JsonReader& reader, const LayeredObject& tool, WrenchDesign& wrench) {
    const auto value = [&](const char* key) { return tool.number(key).value_or(0.0) * mm; };
    wrench.head_angle = default_head_angle;
    if (const auto angle = tool.number("head_angle_deg")) wrench.head_angle = to_radians(*angle);
    wrench.head_thickness = value("head_thickness_mm");
    wrench.jaw_depth = value("jaw_depth_mm");
    wrench.jaw_tip = value("jaw_tip_mm");
    refuse(reader, tool, {"size_mm"}, "an open end is given by its opening", "\"jaw_mm\"");
}

bool is_named(std::string_view tool, const std::vector<AssemblyJoint>& joints) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const AssemblyJoint& joint) { return joint.tool == tool; });
}

// The joints that a tool is to turn: those that name it; if none does, those that name no tool.
std::vector<AssemblyJoint> joints_of(std::string_view tool, const std::vector<AssemblyJoint>& joints) {
    const std::string_view wanted = is_named(tool, joints) ? tool : std::string_view{};
    std::vector<AssemblyJoint> own;
    for (const AssemblyJoint& joint : joints)
        if (joint.tool == wanted) own.push_back(joint);
    return own;
}

// Returns true if a joint type names the tool and a joint has an unknown type, perhaps this one misspelled.
bool lost_its_joints(JsonReader& reader, std::string_view tool, const std::vector<AssemblyJoint>& joints) {
    const auto is_unknown = [](const AssemblyJoint& joint) {
        return joint::turned_part_size(joint.design).across_flats <= 0.0;
    };
    const std::vector<JsonNode> types = reader.items(reader.member(reader.root(), "joint_types"));
    return std::any_of(joints.begin(), joints.end(), is_unknown) &&
           std::any_of(types.begin(), types.end(), [&](const JsonNode& type) {
               return reader.text(reader.member(type, "tool")) == tool;
           });
}

// A tool as read from the file.
struct ParsedTool {
    JsonNode node;
    Located<double> size;  // mm, its opening or its width across flats
    Tool tool;
};

ParsedTool parse_tool(JsonReader& reader, std::string name, const JsonNode& node,
                      const ModelFolders& folders) {
    ParsedTool parsed{node, {}, {std::move(name), read_texts(reader, reader.member(node, "title")), {}}};
    const LayeredObject file(reader, {node});
    WrenchDesign& wrench = parsed.tool.wrench;
    read_kind(reader, file, wrench);
    read_click(reader, file, wrench);
    read_adaptor(reader, file, wrench);
    read_drive(reader, file, wrench);
    wrench.handle_length = file.number("handle_length_mm").value_or(0.0) * mm;
    const bool open_end = wrench.head == ToolHeadKind::open_end;
    if (open_end)
        read_open_end(reader, file, wrench);
    else
        refuse(reader, file, {"jaw_mm", "head_thickness_mm", "jaw_depth_mm", "jaw_tip_mm", "head_angle_deg"},
               fmt::format("{} has no jaw", title_of(wrench.head)), "\"size_mm\" alone");
    parsed.size = file.number(open_end ? "jaw_mm" : "size_mm");
    (open_end ? wrench.jaw : wrench.size) = parsed.size.value_or(0.0) * mm;
    if (!parsed.size && file.all_valid({"kind", "head", "jaw_mm", "size_mm"}) && node.value != nullptr)
        reader.report(node.pointer, fmt::format("the size of {} is missing", title_of(wrench.head)),
                      open_end ? "\"jaw_mm\", its opening" : "\"size_mm\", its width across flats");
    wrench.model = read_tool_model(reader, node, folders);
    for (const JsonNode& other : reader.items(reader.member(node, "instead")))
        parsed.tool.instead[last_token(other.pointer)] = reader.text(other).value_or("");
    return parsed;
}

// Checks that a tool fits the joints that it is to turn.
void check_sizes(JsonReader& reader, const ParsedTool& parsed, const std::vector<AssemblyJoint>& joints) {
    const WrenchDesign& wrench = parsed.tool.wrench;
    // Each trainee may select a tool that no joint type names, so such a tool must fit all joints that name
    // no tool.
    const bool fits_another = !is_named(parsed.tool.name, joints) && suits_any(wrench, joints);
    const std::string remedy = fits_another ? fmt::format(", or \"tool\": {} in the joint types of its size",
                                                          in_quotes(parsed.tool.name))
                                            : "";
    if (wrench.head == ToolHeadKind::open_end)
        check_jaw_room(reader, LayeredObject(reader, {parsed.node}), joints);
    if (parsed.size) check_fit(reader, parsed.size, wrench, joints, remedy);
}

// Returns the indices of the tools for the joints that a variant names: `first`, the tools that a joint
// names, those that fit a joint which names none, and the tools in their "instead". If no tool fits such a
// joint, includes the default one, so that its error is reported.
std::vector<std::size_t> tools_of_selection(const std::vector<ParsedTool>& tools, std::string_view first,
                                            const std::vector<AssemblyJoint>& joints) {
    std::vector<AssemblyJoint> free;
    std::set<std::string_view> names;
    for (const AssemblyJoint& joint : joints)
        joint.tool.empty() ? free.push_back(joint) : (void)names.insert(joint.tool);
    for (const ParsedTool& parsed : tools) {
        const Tool& tool = parsed.tool;
        if (tool.name != first && !suits_any(tool.wrench, free)) continue;
        names.insert(tool.name);
        for (const AssemblyJoint& joint : free)
            if (const auto other = tool.instead.find(joint.design.id); other != tool.instead.end())
                names.insert(other->second);
    }
    const bool lacks_tool =
        !free.empty() && std::none_of(tools.begin(), tools.end(), [&](const auto& parsed) {
            return parsed.tool.name == first || suits_any(parsed.tool.wrench, free);
        });
    if (lacks_tool || names.empty()) names.insert(default_tool_name);
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < tools.size(); ++i)
        if (names.contains(tools[i].tool.name)) kept.push_back(i);
    return kept;
}

// Reports each place that names a tool which the file lacks. Returns false after an error.
bool check_names(JsonReader& reader, const std::vector<Tool>& tools) {
    std::vector<std::string> names;
    for (const Tool& tool : tools) names.push_back(tool.name);
    if (!reader.is_valid(reader.member(reader.root(), "more_tools").pointer)) return false;
    bool known = true;
    const auto check_name = [&](const JsonNode& node) {
        const auto name = reader.text(node);
        if (!name || std::find(names.begin(), names.end(), *name) != names.end()) return;
        known = false;
        const std::string near = nearest_name(*name, names);
        reader.report(node.pointer, fmt::format("there is no tool {}", in_quotes(*name)),
                      near.empty() ? fmt::format("{}", fmt::join(names, ", "))
                                   : fmt::format("did you mean {}?", in_quotes(near)));
    };
    const auto check = [&](const JsonNode& type) { check_name(reader.member(type, "tool")); };
    for (const JsonNode& tool : reader.items(reader.member(reader.root(), "more_tools")))
        for (const JsonNode& other : reader.items(reader.member(tool, "instead"))) check_name(other);
    for (const JsonNode& other : reader.items(reader.member(reader.member(reader.root(), "tool"), "instead")))
        check_name(other);
    for (const JsonNode& type : reader.items(reader.member(reader.root(), "joint_types"))) check(type);
    for (const JsonNode& joint : reader.items(reader.member(reader.root(), "joints")))
        check(reader.member(joint, "override"));
    for (const JsonNode& variant : reader.items(reader.member(reader.root(), "variants"))) {
        check(variant);
        check(reader.member(variant, "every_joint_type"));
        for (const JsonNode& patch : reader.items(reader.member(variant, "joint_types"))) check(patch);
    }
    return known;
}

// Reports each joint type that names a tool of the wrong kind, such as a key for a hexagon. Reports each
// once.
void check_kinds(JsonReader& reader, const std::vector<ParsedTool>& tools,
                 const std::vector<AssemblyJoint>& joints) {
    for (const AssemblyJoint& joint : joints) {
        const auto named = std::find_if(tools.begin(), tools.end(), [&](const ParsedTool& parsed) {
            return parsed.tool.name == joint.tool;
        });
        const joint::TurnedPartSize part = joint::turned_part_size(joint.design);
        if (named == tools.end() || !named->size || part.across_flats <= 0.0) continue;
        const WrenchDesign& wrench = named->tool.wrench;
        const bool has_socket = part.depth > 0.0;
        const bool is_read = LayeredObject(reader, {named->node}).all_valid({"kind", "head"});
        if (!is_read || grips_inside(wrench) == has_socket) continue;
        JsonNode at = reader.items(reader.member(reader.root(), "joints"))[joint.index_in_file];
        const JsonNode types = reader.member(reader.root(), "joint_types");
        for (const JsonNode& holder : {reader.member(at, "override"), reader.member(types, joint.type)})
            if (const JsonNode own = reader.member(holder, "tool"); reader.text(own) == joint.tool) at = own;
        std::vector<std::string> suitable;
        for (const ParsedTool& other : tools)
            if (suits(other.tool.wrench, joint.design)) suitable.push_back(in_quotes(other.tool.name));
        reader.report(
            at.pointer,
            fmt::format("{} is {} and cannot turn {} of {:g} mm", in_quotes(joint.tool),
                        title_of(wrench.head), has_socket ? "the hexagonal socket" : "the hexagon",
                        part.across_flats / mm),
            !suitable.empty() ? fmt::format("{}", fmt::join(suitable, " or "))
            : has_socket ? fmt::format("a hexagon key or a hexagon bit of {:g} mm", part.across_flats / mm)
                         : fmt::format("a ring, a socket or an open end of {:g} mm", part.across_flats / mm));
    }
}

// Reports each joint of an "instead" that the file lacks.
void check_instead(JsonReader& reader, const std::vector<AssemblyJoint>& joints) {
    std::vector<std::string> ids;
    for (const AssemblyJoint& joint : joints) ids.push_back(joint.design.id);
    if (ids.empty() || std::find(ids.begin(), ids.end(), "") != ids.end()) return;  // reported already
    std::vector<JsonNode> tools = reader.items(reader.member(reader.root(), "more_tools"));
    tools.push_back(reader.member(reader.root(), "tool"));
    for (const JsonNode& tool : tools)
        for (const JsonNode& other : reader.items(reader.member(tool, "instead"))) {
            const std::string id = last_token(other.pointer);
            if (std::find(ids.begin(), ids.end(), id) != ids.end()) continue;
            const std::string near = nearest_name(id, ids);
            reader.report(
                other.pointer, fmt::format("there is no joint {}", in_quotes(id)),
                near.empty() ? "the id of a joint" : fmt::format("did you mean {}?", in_quotes(near)),
                JsonPart::key);
        }
}

}  // namespace

double adaptor_ratio(const WrenchDesign& wrench) {
    if (wrench.adaptor_length <= 0.0) return 1.0;
    return joint::adaptor_ratio(wrench.handle_length - wrench.adaptor_length, wrench.adaptor_length);
}

double nominal_size(const WrenchDesign& wrench) {
    return wrench.head == ToolHeadKind::open_end ? wrench.jaw : wrench.size;
}

bool suits(const WrenchDesign& wrench, const joint::JointDesign& joint) {
    const joint::TurnedPartSize part = joint::turned_part_size(joint);
    return (part.depth > 0.0) == grips_inside(wrench) && part.across_flats > 0.0 &&
           has_width(wrench, nominal_size(wrench), part.across_flats);
}

std::vector<Tool> read_tools(JsonReader& reader, const std::string& variant, const VariantJoints& joints,
                             const ModelFolders& folders) {
    std::vector<ParsedTool> parsed;
    parsed.push_back(
        parse_tool(reader, std::string(default_tool_name), reader.member(reader.root(), "tool"), folders));
    for (const JsonNode& node : reader.items(reader.member(reader.root(), "more_tools"))) {
        const std::string name = last_token(node.pointer);
        if (name == default_tool_name)
            reader.report(node.pointer, fmt::format("{} is the name of \"tool\"", in_quotes(name)),
                          "another name", JsonPart::key);
        parsed.push_back(parse_tool(reader, name, node, folders));
    }
    std::vector<Tool> all;
    for (const ParsedTool& tool : parsed) all.push_back(tool.tool);
    const bool names_are_known = check_names(reader, all);
    check_instead(reader, joints.all);
    check_kinds(reader, parsed, joints.joints);

    const JsonNode variants = reader.member(reader.root(), "variants");
    const std::string first =
        reader.text(reader.member(reader.member(variants, variant), "tool")).value_or("");
    std::vector<std::size_t> kept(parsed.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    if (joints.named_by_variant) {
        for (const ParsedTool& tool : parsed)  // a tool of another variant
            if (!suits_any(tool.tool.wrench, joints.all)) check_sizes(reader, tool, joints.all);
        kept = tools_of_selection(parsed, first, joints.joints);
    }
    std::vector<Tool> tools;
    for (const std::size_t i : kept) {
        const std::string& name = parsed[i].tool.name;
        // A tool that has lost its joints by a misspelled name is not compared with other joints.
        if (is_named(name, joints.joints) || (names_are_known && !lost_its_joints(reader, name, joints.all)))
            check_sizes(reader, parsed[i], joints_of(name, joints.joints));
        tools.push_back(parsed[i].tool);
    }
    std::stable_partition(tools.begin(), tools.end(), [&](const Tool& tool) { return tool.name == first; });
    return tools;
}

}  // namespace bolt::content
