#include "tools/author/geometry/joint_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "game/tool_models/tool_model.hpp"

namespace bolt::geometry {

namespace {

constexpr double beyond_grip = 50.0 * mm;  // from the middle of the grip to the end of the handle
constexpr double much_torque = 0.8;        // of the torque that the tool bears, beyond which there is a note
constexpr double much_force = 800.0;       // N at the grip, beyond which there is a note (ours)

}  // namespace

collision::TurnedShape shape_of(const joint::JointDesign& design) {
    const joint::TurnedPartSize part = joint::turned_part_size(design);
    if (part.depth > 0.0)
        return collision::HexagonSocket{part.across_flats, part.depth, part.height, part.outside};
    return collision::HexagonPrism{part.across_flats, part.height, part.bearing};
}

std::string title_of(const content::WrenchDesign& design) {
    const double size = content::nominal_size(design) / mm;
    switch (design.head) {
        case content::ToolHeadKind::open_end:
            return fmt::format("an open end of {:g} mm", tool_models::parameters_of(design).size / mm);
        case content::ToolHeadKind::ring:
            return fmt::format("a ring of {:g} mm", size);
        case content::ToolHeadKind::socket:
            return fmt::format("a socket of {:g} mm", size);
        case content::ToolHeadKind::hex_key:
            return fmt::format("a hexagon key of {:g} mm", size);
        case content::ToolHeadKind::hex_bit:
            break;
    }
    return fmt::format("a hexagon bit of {:g} mm", size);
}

std::string name_of_tool(const content::Assembly& assembly, std::size_t tool) {
    return assembly.tools[tool].name == content::default_tool_name
               ? "the wrench"
               : "the tool " + content::in_quotes(assembly.tools[tool].name);
}

std::vector<content::WrenchDesign> usual_tools(const joint::JointDesign& design) {
    using content::ToolHeadKind;
    using content::ToolKind;
    const joint::TurnedPartSize part = joint::turned_part_size(design);
    std::vector<std::pair<ToolKind, ToolHeadKind>> kinds{{ToolKind::ring_wrench, ToolHeadKind::ring},
                                                         {ToolKind::ratchet, ToolHeadKind::socket},
                                                         {ToolKind::open_end_wrench, ToolHeadKind::open_end}};
    if (part.depth > 0.0)
        kinds = {{ToolKind::hex_key, ToolHeadKind::hex_key}, {ToolKind::ratchet, ToolHeadKind::hex_bit}};
    std::vector<content::WrenchDesign> tools;
    for (const auto& [kind, head] : kinds) {
        content::WrenchDesign tool;
        tool.kind = kind;
        tool.head = head;
        if (head == ToolHeadKind::open_end) {
            tool.jaw = part.across_flats + tool_models::standard_play;
            tool.head_angle = to_radians(15.0);
        } else {
            tool.size = part.across_flats;
        }
        tool_models::ToolParameters usual = tool_models::parameters_of(tool);
        usual.length = 0.0;
        const auto whole = tool_models::completed(usual);
        if (!whole) continue;  // no such tool has this size
        tool.teeth = whole->teeth;
        tool.handle_length = whole->length - beyond_grip;
        tools.push_back(tool);
    }
    return tools;
}

namespace {

// The tools that can turn a joint, for messages: those of the file, otherwise kinds and sizes.
std::string suitable_tools(const content::Assembly& assembly, const joint::JointDesign& design) {
    std::string names;
    for (const content::Tool& tool : assembly.tools)
        if (content::suits(tool.wrench, design))
            names += fmt::format("{}{}", names.empty() ? "" : " or ", content::in_quotes(tool.name));
    if (!names.empty()) return fmt::format("{} as \"tool\" of its joint type", names);
    for (const content::WrenchDesign& usual : usual_tools(design))
        names += fmt::format("{}{}", names.empty() ? "" : ", or ", title_of(usual));
    return names;
}

// The kinds of tools that bear a torque (N·m) on the part of a joint.
std::string strong_tools(const joint::JointDesign& design, double torque) {
    std::string names;
    for (const content::WrenchDesign& usual : usual_tools(design)) {
        const double bearable = tool_models::bearable_torque(usual);
        if (bearable < torque) continue;
        names += fmt::format("{}{} ({:.0f} N·m)", names.empty() ? "" : " or ", title_of(usual), bearable);
    }
    return names.empty() ? "a lower target torque: no tool of this size bears it" : names;
}

std::string origin_of(const tool_models::ToolStrength& strength) {
    switch (strength.limit.source) {
        case tool_models::TorqueSource::tabulated:
            return "ISO 1711-1, from a catalogue";
        case tool_models::TorqueSource::interpolated:
            return "interpolated between sizes of ISO 1711-1";
        default:
            return strength.of_drive ? "an estimate for its square drive"
                                     : "an estimate beyond the sizes of ISO 1711-1 that are known";
    }
}

// The torque that a tool bears, N·m, and a phrase that states it with its origin.
struct StatedTorque {
    double torque = 0.0;
    std::string phrase;
};

StatedTorque stated_torque(const content::WrenchDesign& design) {
    const tool_models::ToolStrength strength = tool_models::strength_of(design);
    const double bearable = tool_models::bearable_torque(design);
    if (strength.limit.source == tool_models::TorqueSource::none || bearable < strength.limit.torque)
        return {bearable,
                fmt::format(", which begins to bend at {:.0f} N·m (torsion of its hexagon)", bearable)};
    const std::string part =
        strength.of_drive ? fmt::format(" on a square drive of {:g} mm", strength.drive / mm) : "";
    return {bearable,
            fmt::format("{}, which is tested with {:.0f} N·m ({})", part, bearable, origin_of(strength))};
}

// Notes a handle that is too short for a person. The hand of a lesson turns it nevertheless.
void check_force(const content::AssemblyJoint& joint, const content::WrenchDesign& design,
                 const std::string& name, const Messages& messages) {
    const double torque = joint.spec.torque.target;
    const double force = torque / std::max(design.handle_length, 1e-3);
    if (force <= much_force) return;
    messages.note(
        joint_pointer(joint.index_in_file),
        fmt::format("{} with its handle of {:g} mm takes {:.0f} N at the grip for the target torque of {}, "
                    "{:g} N·m; a handle of {:.0f} mm takes at most {:.0f} N",
                    name, design.handle_length / mm, force, content::in_quotes(joint.type), torque,
                    std::ceil(torque / much_force / (10.0 * mm)) * 10.0, much_force));
}

// `optional`: a lesson can be done without this tool, so its choice may be a mistake that the author intends.
void check_torque(const content::AssemblyJoint& joint, const content::WrenchDesign& design, bool optional,
                  const std::string& name, const Messages& messages) {
    const StatedTorque bearable = stated_torque(design);
    const double torque = joint.spec.torque.high;
    if (bearable.torque <= 0.0 || torque <= much_torque * bearable.torque) return;
    const std::string what =
        fmt::format("{} is {}{}, and the target torque of {} reaches {:.0f} N·m", name, title_of(design),
                    bearable.phrase, content::in_quotes(joint.type), torque);
    const std::string pointer = joint_pointer(joint.index_in_file);
    if (torque > bearable.torque && optional)
        messages.note(pointer, what + "; a trainee who chooses it loses points");
    else if (torque > bearable.torque)
        messages.error(pointer, what, strong_tools(joint.design, torque));
    else
        messages.note(pointer, fmt::format("{}, {:.0f} % of it", what, 100.0 * torque / bearable.torque));
}

}  // namespace

void check_tools(const content::Assembly& assembly, const Messages& messages) {
    std::set<std::tuple<std::string, std::size_t, double, double>> checked;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const content::AssemblyJoint& joint = assembly.joints[i];
        const joint::TurnedPartSize part = joint::turned_part_size(joint.design);
        const std::vector<std::size_t> tools = content::tools_of_joint(assembly, i);
        for (const std::size_t tool : tools) {
            if (!checked.emplace(joint.type, tool, part.across_flats, joint.spec.torque.high).second)
                continue;
            const content::WrenchDesign& design = assembly.tools[tool].wrench;
            const std::string name = name_of_tool(assembly, tool);
            if (content::suits(design, joint.design)) {
                check_torque(joint, design, tool != tools.front(), name, messages);
                check_force(joint, design, name, messages);
            } else {
                messages.error(joint_pointer(joint.index_in_file),
                               fmt::format("{} is {} and does not fit the {} of {}, {} of {:g} mm", name,
                                           title_of(design),
                                           joint.design.turned == joint::TurnedPart::head ? "head" : "nut",
                                           content::in_quotes(joint.design.id),
                                           part.depth > 0.0 ? "a hexagonal socket" : "a hexagon",
                                           part.across_flats / mm),
                               suitable_tools(assembly, joint.design));
            }
        }
    }
}

}  // namespace bolt::geometry
