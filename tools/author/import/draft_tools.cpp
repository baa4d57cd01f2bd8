#include "tools/author/import/draft_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/tool_models/parameters.hpp"

namespace bolt::step_import {

namespace {

constexpr std::size_t most_tools = 11;      // "tool", and ten of "more_tools" (assembly.schema.json)
constexpr double jaw_play = 0.2 * mm;       // of an open end
constexpr double grip_share = 0.9;          // middle of the grip on a key / length of its long arm
constexpr double shortest_key = 40.0 * mm;  // to the grip
constexpr double shortest_ratchet = 150.0 * mm;

// Length of an open-end wrench from the jaw to the grip, which suits the torque of its size, m.
double wrench_handle(double across_flats) {
    return std::round((8.2 * across_flats + 33.0 * mm) / (10.0 * mm)) * 10.0 * mm;
}

void describe_open_end(DraftTool& tool) {
    const double s = tool.need.across_flats / mm, handle = wrench_handle(tool.need.across_flats) / mm;
    tool.name = fmt::format("open_end_{:g}", s);
    tool.json = fmt::format(
        R"({{ "kind": "open_end_wrench", "jaw_mm": {:g}, "head_angle_deg": 15, "handle_length_mm": {:g} }})",
        s + jaw_play / mm, handle);
    tool.description =
        fmt::format("an open-end wrench of {:g} mm, {:g} mm from the jaw to the grip", s, handle);
}

void describe_key(DraftTool& tool) {
    const double s = tool.need.across_flats;
    const double arm = grip_share * tool_models::key_arms(s).handle;
    const double handle = std::round(std::max(arm, shortest_key) / mm);
    tool.name = fmt::format("hex_key_{:g}", s / mm);
    tool.json =
        fmt::format(R"({{ "kind": "hex_key", "size_mm": {:g}, "handle_length_mm": {:g} }})", s / mm, handle);
    tool.description =
        fmt::format("a hexagon key of {:g} mm, {:g} mm from the screw to the grip", s / mm, handle);
}

void describe_bit(DraftTool& tool) {
    const double s = tool.need.across_flats / mm;
    // As long as the wrench of a hexagon head with this thread, which is about 1.5 d wide.
    const double handle = std::max(wrench_handle(1.5 * tool.need.thread), shortest_ratchet) / mm;
    tool.name = fmt::format("hex_bit_{:g}", s);
    tool.json = fmt::format(
        R"({{ "kind": "ratchet", "head": "hex_bit", "size_mm": {:g}, "handle_length_mm": {:g} }})", s,
        handle);
    tool.description =
        fmt::format("a ratchet with a hexagon bit of {:g} mm, {:g} mm from the screw to the grip", s, handle);
}

}  // namespace

std::vector<DraftTool> draft_tools(const std::vector<ToolNeed>& needs) {
    std::vector<DraftTool> tools;
    for (const ToolNeed& need : needs) {
        const auto known = std::find_if(tools.begin(), tools.end(),
                                        [&](const DraftTool& tool) { return tool.need == need; });
        if (known == tools.end())
            tools.push_back({need, 1, {}, {}, {}});
        else
            ++known->joints;
    }
    std::stable_sort(tools.begin(), tools.end(),
                     [](const DraftTool& a, const DraftTool& b) { return a.joints > b.joints; });
    if (tools.size() > most_tools) tools.resize(most_tools);
    for (DraftTool& tool : tools) {
        if (tool.need.head == joint::HeadShape::hexagon)
            describe_open_end(tool);
        else if (tool.need.across_flats < largest_key + 1e-6)
            describe_key(tool);
        else
            describe_bit(tool);
    }
    if (!tools.empty()) tools.front().name.clear();
    return tools;
}

}  // namespace bolt::step_import
