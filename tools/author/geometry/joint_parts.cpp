#include "tools/author/geometry/joint_parts.hpp"

#include <algorithm>
#include <glm/matrix.hpp>

namespace bolt::geometry {

namespace {

Vec3 moved(const glm::dmat4& m, const Vec3& p) { return Vec3(m * glm::dvec4(p, 1.0)); }

Fastener find_fastener(const Scene& scene, int joint_node, std::string name, const glm::dmat4& to_joint) {
    Fastener fastener;
    fastener.name = std::move(name);
    const auto found = scene.by_name.find(fastener.name);
    if (found == scene.by_name.end()) return fastener;
    for (const int node : found->second) {
        if (!scene.is_under(node, joint_node)) continue;
        for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
            if (!scene.is_under(scene.parts[i].node, node)) continue;
            fastener.parts.insert(i);
            for (const Triangle& t : scene.parts[i].triangles) {
                fastener.triangles.push_back(
                    {moved(to_joint, t.a), moved(to_joint, t.b), moved(to_joint, t.c), i});
                const Triangle& own = fastener.triangles.back();
                for (const Vec3& p : {own.a, own.b, own.c}) fastener.box.add(p);
            }
        }
    }
    return fastener;
}

Box moved(const glm::dmat4& m, const Box& box) {
    const Vec3 middle = moved(m, box.middle()), half = box.half();
    const Vec3 reach =
        glm::abs(Vec3(m[0])) * half.x + glm::abs(Vec3(m[1])) * half.y + glm::abs(Vec3(m[2])) * half.z;
    return {middle - reach, middle + reach};
}

// Something of the box may be within the radius of the Y axis and above the floor.
bool is_near(const Box& box, double radius, double floor) {
    const double x = std::max({box.low.x, -box.high.x, 0.0}), z = std::max({box.low.z, -box.high.z, 0.0});
    return box.high.y > floor && std::hypot(x, z) < radius;
}

}  // namespace

bool JointParts::owns(std::uint32_t part) const {
    return bolt.parts.contains(part) || washer_head.parts.contains(part) || washer_nut.parts.contains(part) ||
           nut.parts.contains(part);
}

JointParts find_joint_parts(const Scene& scene, int joint_node, std::string_view id) {
    JointParts parts;
    parts.to_assembly = scene.nodes[static_cast<std::size_t>(joint_node)].world;
    parts.to_joint = glm::inverse(parts.to_assembly);
    const auto find = [&](const char* what) {
        return find_fastener(scene, joint_node, std::string(id) + what, parts.to_joint);
    };
    parts.bolt = find("_bolt");
    parts.washer_head = find("_washer_head");
    parts.washer_nut = find("_washer_nut");
    parts.nut = find("_nut");
    return parts;
}

std::vector<Triangle> surroundings(const Scene& scene, const glm::dmat4& to_joint, double radius,
                                   double floor, const std::set<std::uint32_t>& left_out) {
    std::vector<Triangle> result;
    for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
        const Part& part = scene.parts[i];
        if (left_out.contains(i) || part.triangles.empty() ||
            !is_near(moved(to_joint, part.box), radius, floor))
            continue;
        for (const Triangle& t : part.triangles) {
            const Triangle own{moved(to_joint, t.a), moved(to_joint, t.b), moved(to_joint, t.c), i};
            Box box;
            for (const Vec3& p : {own.a, own.b, own.c}) box.add(p);
            if (is_near(box, radius, floor)) result.push_back(own);
        }
    }
    return result;
}

}  // namespace bolt::geometry
