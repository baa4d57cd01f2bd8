// Checks the joints of an assembly file against each other: unique names, and positions that leave room for
// each joint.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "content/format/json_document.hpp"
#include "content/format/read_joints.hpp"

namespace bolt::content {

namespace {

// Width of the part that is turned, m.
double outer_width(const joint::JointDesign& design) {
    const joint::TurnedPartSize part = joint::turned_part_size(design);
    const joint::SocketHead* const socket =
        part.depth > 0.0 ? joint::socket_head(design.thread.size.name) : nullptr;
    return socket ? socket->diameter : part.across_flats;
}

// A joint whose turned part overlaps that of an earlier joint.
struct Overlap {
    std::size_t joint = 0, other = 0;  // indices
    double distance = 0.0;             // m
    double needed = 0.0;               // m
};

// `indices`: of the joints with a valid position. `scale`: factor on all positions.
std::vector<Overlap> find_overlaps(const std::vector<AssemblyJoint>& joints,
                                   const std::vector<std::size_t>& indices, double scale) {
    std::vector<Overlap> overlaps;
    for (std::size_t i = 0; i < indices.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const joint::JointDesign &a = joints[indices[i]].design, &b = joints[indices[k]].design;
            const double distance = scale * glm::length(a.seat - b.seat);
            const double needed = std::max(outer_width(a), outer_width(b));
            if (distance >= needed) continue;
            overlaps.push_back({indices[i], indices[k], distance, needed});
            break;
        }
    return overlaps;
}

// The unit in which all positions are probably given; null if they are millimetres.
const char* wrong_unit(const std::vector<AssemblyJoint>& joints, const std::vector<std::size_t>& indices) {
    constexpr std::pair<double, const char*> units[] = {
        {10.0, "centimetres"}, {25.4, "inches"}, {1000.0, "metres"}};
    for (const auto& [scale, name] : units)
        if (find_overlaps(joints, indices, scale).empty()) return name;
    return nullptr;
}

// Reports turned parts that overlap. If most joints overlap because of a wrong unit, reports the unit
// instead.
void check_overlaps(JsonReader& reader, const std::vector<JsonNode>& nodes,
                    const std::vector<AssemblyJoint>& joints) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const JsonNode position = reader.member(nodes[i], "position_mm");
        if (position && reader.is_valid(position.pointer) &&
            reader.is_valid(reader.member(nodes[i], "axis").pointer))
            indices.push_back(i);
    }
    const auto pointer = [&](std::size_t joint) {
        return reader.member(nodes[joint], "position_mm").pointer;
    };
    const std::vector<Overlap> overlaps = find_overlaps(joints, indices, 1.0);
    const bool most = overlaps.size() > 1 && 2 * overlaps.size() >= indices.size();
    if (const char* unit = most ? wrong_unit(joints, indices) : nullptr) {
        reader.report(
            pointer(indices.front()),
            fmt::format("with such positions {} of {} joints overlap; it looks as if position_mm is in {}",
                        overlaps.size() + 1, indices.size(), unit),
            "millimetres");
        return;
    }
    for (const Overlap& overlap : overlaps)
        reader.report(
            pointer(overlap.joint),
            fmt::format("this joint is {:.3g} mm from {}: their {}s overlap", overlap.distance / mm,
                        in_quotes(joints[overlap.other].design.id),
                        joints[overlap.joint].design.turned == joint::TurnedPart::head ? "head" : "nut"),
            fmt::format("{:g} mm or more", overlap.needed / mm));
}

}  // namespace

void check_joints(JsonReader& reader, const std::vector<JsonNode>& nodes,
                  const std::vector<AssemblyJoint>& joints) {
    const auto unique = [&](const char* key) {
        std::map<std::string, std::string> first;
        for (const JsonNode& node : nodes) {
            const JsonNode value = reader.member(node, key);
            const auto name = reader.text(value);
            if (!name) continue;
            const auto [it, fresh] = first.emplace(*name, value.pointer);
            if (!fresh)
                reader.report(
                    value.pointer,
                    fmt::format("{} is the \"{}\" of another joint too", in_quotes(*name), key),
                    fmt::format("a name of its own; it is used first in line {}", reader.line(it->second)));
        }
    };
    unique("id");
    unique("node");
    check_overlaps(reader, nodes, joints);
}

}  // namespace bolt::content
