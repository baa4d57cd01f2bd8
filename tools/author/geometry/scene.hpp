// A glTF model flattened into the assembly's frame (metres), the fasteners of one joint in the joint's frame,
// and the measurement of a hexagon.
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "haptics/joint/design.hpp"
#include "tools/author/geometry/bvh.hpp"

namespace bolt::geometry {

struct ModelNode {
    std::string name;
    int parent = -1;
    glm::dmat4 world{1.0};
};

// The mesh of one node, in the assembly's frame.
struct ModelPart {
    std::string name;  // of the node or of its nearest named ancestor
    int node = -1;     // index into FlattenedModel::nodes
    std::vector<Triangle> triangles;
    Aabb box;
};

struct FlattenedModel {
    std::vector<ModelNode> nodes;  // a parent before its children
    std::vector<ModelPart> parts;
    std::map<std::string, std::vector<int>, std::less<>> by_name;  // indices into `nodes`

    [[nodiscard]] bool is_under(int node, int ancestor) const;  // true also for node == ancestor
    [[nodiscard]] std::size_t triangle_count() const;
    [[nodiscard]] std::vector<std::string> names() const;
};

// Places every mesh instance of the default scene. Ignores triangles with indices out of range or non-finite
// corners.
FlattenedModel flatten(const assets::Model& model);

// A fastener in the frame of its joint: origin in the middle of the hole on the face under the turned part,
// +Y along the bolt towards that part.
struct Fastener {
    std::string name;                 // of its node
    std::vector<Triangle> triangles;  // Triangle::part: index into FlattenedModel::parts
    Aabb box;
    std::set<std::uint32_t> parts;

    [[nodiscard]] bool exists() const { return !triangles.empty(); }
};

// The fasteners of one joint.
struct JointParts {
    glm::dmat4 to_joint{1.0}, to_assembly{1.0};
    Fastener bolt, washer_head, washer_nut, nut;
    Fastener turned;         // the nut, or the head of a bolt that is turned at its head
    Fastener turned_washer;  // under that part

    [[nodiscard]] bool owns(std::uint32_t part) const;  // the part is in one of the fasteners
};

// The frame of a joint at its node, in the assembly's frame. If the node is the screw itself, a mesh, its +Y
// may point against the axis of the design; the frame is then turned over.
glm::dmat4 joint_frame(const FlattenedModel& scene, int joint_node, const joint::JointDesign& design);

// Finds the nodes ID_bolt, ID_washer_head, ID_washer_nut and ID_nut under the joint's node; a missing node
// gives a fastener without triangles. If the joint's node is the screw itself, it is the bolt. A head that is
// turned is the part of ID_bolt that is above the bearing face or wider than the shank.
JointParts find_joint_parts(const FlattenedModel& scene, int joint_node, const joint::JointDesign& design);

// The axis-aligned box around a transformed box.
Aabb transform_to(const glm::dmat4& m, const Aabb& box);

// A hexagon about +Y, measured on its mesh.
struct MeasuredHexagon {
    double across_flats = 0.0;  // m, mean of the three widths
    double unevenness = 0.0;    // m, widest minus narrowest
    double flat_angle = 0.0;    // rad, of the outward normal of one flat, from +X towards +Z
    Vec3 centre{0.0};           // m, offset from the axis; y is 0
};

// Returns nullopt if the triangles have no six flats about the axis.
std::optional<MeasuredHexagon> measure_hexagon(std::span<const Triangle> triangles);

}  // namespace bolt::geometry
