// The fasteners of one joint, in the joint's own frame: origin in the middle of the hole on the face under
// the nut, +Y along the bolt towards the nut.
#pragma once

#include <glm/mat4x4.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

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

}  // namespace bolt::geometry
