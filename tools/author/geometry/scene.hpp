// A model with every instance in its place: nodes by name, parts as triangles in the assembly's frame.
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
#include "tools/author/geometry/bvh.hpp"

namespace bolt::geometry {

struct SceneNode {
    std::string name;
    int parent = -1;
    glm::dmat4 world{1.0};
};

// A node's mesh.
struct Part {
    std::string name;  // of the node, or of the nearest one above it that has a name
    int node = -1;     // of the scene
    std::vector<Triangle> triangles;
    Box box;
};

struct Scene {
    std::vector<SceneNode> nodes;  // a parent before its children
    std::vector<Part> parts;
    std::map<std::string, std::vector<int>, std::less<>> by_name;

    [[nodiscard]] bool is_under(int node, int ancestor) const;  // or is the same
    [[nodiscard]] std::size_t triangle_count() const;
    [[nodiscard]] std::vector<std::string> names() const;
};

Scene flatten(const assets::Model& model);

// The fasteners of one joint, in the joint's own frame: origin in the middle of the hole on the face under
// the nut, +Y along the bolt towards the nut.

struct Fastener {
    std::string name;                 // of its node
    std::vector<Triangle> triangles;  // part: index into the scene's parts
    Box box;
    std::set<std::uint32_t> parts;

    [[nodiscard]] bool there() const { return !triangles.empty(); }
};

struct JointParts {
    glm::dmat4 to_joint{1.0}, to_assembly{1.0};
    Fastener bolt, washer_head, washer_nut, nut;

    [[nodiscard]] bool owns(std::uint32_t part) const;
};

JointParts find_joint_parts(const Scene& scene, int joint_node, std::string_view id);

// What stands within `radius` of the joint's axis and reaches above `floor`, in the joint's frame, but for
// the parts that are left out.
std::vector<Triangle> surroundings(const Scene& scene, const glm::dmat4& to_joint, double radius,
                                   double floor, const std::set<std::uint32_t>& left_out);

// A hexagon about +Y, measured off its mesh.

struct Hexagon {
    double across_flats = 0.0;     // m, mean of the three widths
    double unevenness = 0.0;       // m, the widest less the narrowest
    Vec3 centre{0.0};              // m, beside the axis; y is 0
    double low = 0.0, high = 0.0;  // m, along the axis
};

// None if the triangles show no six flats about the axis.
std::optional<Hexagon> measure_hexagon(std::span<const Triangle> triangles);

}  // namespace bolt::geometry
