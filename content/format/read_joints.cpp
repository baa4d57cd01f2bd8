#include <fmt/format.h>

#include <map>

#include "content/format/json_pointer.hpp"
#include "content/format/read_assembly.hpp"
#include "content/format/read_joint_type.hpp"
#include "content/format/wording.hpp"

namespace bolt::content {

namespace {

constexpr double mm = 1e-3;

std::vector<std::string> names_of(const Reader& reader, const Node& object) {
    std::vector<std::string> names;
    for (const Node& node : reader.items(object)) names.push_back(last_token(node.pointer));
    return names;
}

void report_unknown(Reader& reader, std::string_view pointer, Part part, std::string_view kind,
                    std::string_view name, const std::vector<std::string>& known) {
    reader.report(pointer, fmt::format("{} is no {}", in_quotes(name), kind), suggest(name, known), part);
}

struct Types {
    Reader& reader;
    bool patched;      // by a variant
    Node all;          // "joint_types"
    Node every_patch;  // of the variant
    Node patches;      // of the variant, by type
    Materials materials;
    double least_share;  // of the target torque, of all passes
    std::map<std::string, JointType> read;

    Layers layers(const std::string& name) {
        if (!patched) return {reader, {reader.member(all, name)}};
        return {reader, {reader.member(patches, name), every_patch, reader.member(all, name)}};
    }
};

Vec3 read_axis(Reader& reader, const Node& joint) {
    const Node node = reader.member(joint, "axis");
    const Vec3 axis = reader.vector(node).value_or(Vec3{0.0, 1.0, 0.0});
    const double length = std::sqrt(glm::dot(axis, axis));
    if (std::abs(length - 1.0) > 0.001) {
        reader.report(
            node.pointer,
            length < 1e-6 ? "the axis has no length" : fmt::format("the axis has the length {:.4g}", length),
            "expected a unit vector, as in [0, 1, 0]");
        return {0.0, 1.0, 0.0};
    }
    return axis / length;
}

AssemblyJoint read_joint(Types& types, const Node& node) {
    Reader& reader = types.reader;
    AssemblyJoint joint{};
    joint.type = reader.text(reader.member(node, "type")).value_or("");
    joint.node = reader.text(reader.member(node, "node")).value_or("");
    const Node override = reader.member(node, "override");
    if (types.read.contains(joint.type)) {
        JointType type = types.read.at(joint.type);
        if (override) {
            std::vector<Node> objects = types.layers(joint.type).objects();
            objects.insert(objects.begin(), override);
            type = read_joint_type(Layers(reader, std::move(objects)), types.materials, types.least_share);
        }
        joint.design = std::move(type.design);
        joint.spec = type.spec;
    }
    joint.design.id = reader.text(reader.member(node, "id")).value_or("");
    joint.design.axis = read_axis(reader, node);
    const double washer = joint.design.washer_under_nut ? joint.design.thread.size.washer_thickness : 0.0;
    joint.design.seat = reader.vector(reader.member(node, "position_mm")).value_or(Vec3{0.0}) * mm +
                        washer * joint.design.axis;
    return joint;
}

// Ids and nodes are names of their own; two joints do not stand in one place.
void check_joints(Reader& reader, const std::vector<Node>& nodes, const std::vector<AssemblyJoint>& joints) {
    const auto unique = [&](const char* key) {
        std::map<std::string, std::string> first;
        for (const Node& node : nodes) {
            const Node value = reader.member(node, key);
            const auto name = reader.text(value);
            if (!name) continue;
            const auto [it, fresh] = first.emplace(*name, value.pointer);
            if (!fresh)
                reader.report(value.pointer,
                              fmt::format("{} is the \"{}\" of another joint too", in_quotes(*name), key),
                              fmt::format("expected a name of its own; it is used first in line {}",
                                          reader.line(it->second)));
        }
    };
    unique("id");
    unique("node");
    const auto placed = [&](const Node& node) {
        const Node place = reader.member(node, "position_mm");
        return place && reader.sound(place.pointer) && reader.sound(reader.member(node, "axis").pointer);
    };
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const Node place = reader.member(nodes[i], "position_mm");
        if (!placed(nodes[i])) continue;
        for (std::size_t k = 0; k < i; ++k) {
            if (!placed(nodes[k])) continue;
            const Vec3 apart = joints[i].design.seat - joints[k].design.seat;
            const double distance = std::sqrt(glm::dot(apart, apart));
            const double nut = joints[i].design.thread.size.across_flats;
            if (distance >= nut) continue;
            reader.report(place.pointer,
                          fmt::format("this joint is {:.3g} mm from {}: their nuts overlap", distance / mm,
                                      in_quotes(joints[k].design.id)),
                          fmt::format("expected {:g} mm or more", nut / mm));
            break;
        }
    }
}

}  // namespace

std::vector<AssemblyJoint> read_joints(Reader& reader, const std::string& variant) {
    const Node root = reader.root();
    const Node patch = variant.empty() ? Node{} : reader.member(reader.member(root, "variants"), variant);
    Types types{reader,
                !variant.empty(),
                reader.member(root, "joint_types"),
                reader.member(patch, "every_joint_type"),
                reader.member(patch, "joint_types"),
                read_materials(reader),
                least_share(reader),
                {}};
    const std::vector<std::string> type_names = names_of(reader, types.all);
    const bool types_known = static_cast<bool>(types.all);
    for (const std::string& name : type_names)
        types.read.emplace(name, read_joint_type(types.layers(name), types.materials, types.least_share));
    for (const Node& node : reader.items(types.patches))
        if (types_known && !types.read.contains(last_token(node.pointer)))
            report_unknown(reader, node.pointer, Part::key, "joint type of this file",
                           last_token(node.pointer), type_names);

    const std::vector<Node> nodes = reader.items(reader.member(root, "joints"));
    std::vector<AssemblyJoint> joints;
    for (const Node& node : nodes) {
        joints.push_back(read_joint(types, node));
        const Node type = reader.member(node, "type");
        if (type && types_known && !types.read.contains(joints.back().type))
            report_unknown(reader, type.pointer, Part::value, "joint type of this file", joints.back().type,
                           type_names);
    }
    check_joints(reader, nodes, joints);
    return joints;
}

}  // namespace bolt::content
