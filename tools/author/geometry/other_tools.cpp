#include "tools/author/geometry/other_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "content/format/json_document.hpp"
#include "game/tool_models/tool_model.hpp"
#include "tools/author/geometry/joint_tools.hpp"

namespace bolt::geometry {

namespace {

constexpr std::array extension_bars{75.0 * mm, 125.0 * mm, 250.0 * mm};

bool has_drive(const content::WrenchDesign& design) {
    return design.head == content::ToolHeadKind::socket || design.head == content::ToolHeadKind::hex_bit;
}

}  // namespace

const ToolGeometry* ToolSet::generate(const content::WrenchDesign& design) {
    const std::string key = tool_models::description(tool_models::parameters_of(design));
    auto found = generated_.find(key);
    if (found == generated_.end()) {
        auto made = generated_tool(design);
        found = generated_.emplace(key, made ? std::optional(std::move(*made)) : std::nullopt).first;
    }
    return found->second ? &*found->second : nullptr;
}

const ToolRoom& JointRooms::room_of(const ToolGeometry& tool) {
    const auto found = rooms_.find(&tool);
    if (found != rooms_.end()) return found->second;
    return rooms_.emplace(&tool, surroundings_.room_for(tool)).first->second;
}

std::string JointRooms::fitting_extension(const content::WrenchDesign& design) {
    if (!has_drive(design)) return {};
    content::WrenchDesign longer = design;
    for (const double bar : extension_bars) {
        if (bar <= design.extension) continue;
        longer.extension = bar;
        const ToolGeometry* shape = tools_.generate(longer);
        if (shape != nullptr && room_of(*shape).is_sufficient)
            return fmt::format("an extension bar of {0:g} mm (\"extension_mm\": {0:g})", bar / mm);
    }
    return {};
}

std::string JointRooms::fitting_tool_of_file(std::size_t tool) {
    const content::Assembly& assembly = tools_.assembly();
    const content::AssemblyJoint& joint = surroundings_.joint();
    // A torque wrench is best replaced by another one.
    for (const bool same_use : {true, false}) {
        std::string names;
        for (std::size_t i = 0; i < assembly.tools.size(); ++i) {
            const content::WrenchDesign& design = assembly.tools[i].wrench;
            const bool measures = content::is_torque_wrench(design.kind);
            if (i == tool ||
                (measures == content::is_torque_wrench(assembly.tools[tool].wrench.kind)) != same_use ||
                !content::suits(design, joint.design) || !room_of(tools_.shapes()[i]).is_sufficient)
                continue;
            names +=
                fmt::format("{}{}", names.empty() ? "" : " or ", content::in_quotes(assembly.tools[i].name));
        }
        if (names.empty()) continue;
        return joint.tool.empty() ? fmt::format("\"instead\": {{ {}: {} }}, which fits",
                                                content::in_quotes(joint.design.id), names)
                                  : fmt::format("\"tool\": {} in its joint type, which fits", names);
    }
    return {};
}

std::string JointRooms::usual_fitting_tool(const content::WrenchDesign& design) {
    for (const content::WrenchDesign& usual : usual_tools(surroundings_.joint().design)) {
        if (usual.kind == design.kind && usual.head == design.head) continue;
        const ToolGeometry* shape = tools_.generate(usual);
        if (shape != nullptr && room_of(*shape).is_sufficient)
            return fmt::format("{} with a handle of {:.0f} mm, which fits", title_of(usual),
                               usual.handle_length / mm);
    }
    return {};
}

std::string JointRooms::describe_fitting_tool(std::size_t tool) {
    const content::WrenchDesign& design = tools_.assembly().tools[tool].wrench;
    std::string found = fitting_extension(design);
    if (found.empty()) found = fitting_tool_of_file(tool);
    if (found.empty()) found = usual_fitting_tool(design);
    return found;
}

}  // namespace bolt::geometry
