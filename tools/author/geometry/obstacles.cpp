#include "tools/author/geometry/obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::geometry {

std::vector<Bvh> build_part_trees(const FlattenedModel& scene) {
    std::vector<Bvh> trees;
    trees.reserve(scene.parts.size());
    for (const ModelPart& part : scene.parts) trees.emplace_back(part.triangles);
    return trees;
}

Obstacles::Obstacles(const Bvh& all) {
    if (!all.nodes().empty()) parts_.push_back({&all, all.box()});
}

Obstacles::Obstacles(const std::vector<Bvh>& trees, const glm::dmat4& to_joint, const glm::dmat4& to_assembly,
                     const std::set<std::uint32_t>& left_out)
    : from_joint_{glm::dmat3(to_assembly), Vec3(to_assembly[3])} {
    for (std::uint32_t i = 0; i < trees.size(); ++i)
        if (!left_out.contains(i) && !trees[i].nodes().empty())
            parts_.push_back({&trees[i], transform_to(to_joint, trees[i].box())});
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
        return glm::length(a.box.half()) < glm::length(b.box.half());
    });
}

Obstacles Obstacles::near_axis(double radius, double low, double high) const {
    Obstacles near = *this;
    std::erase_if(near.parts_, [&](const Part& part) {
        const double x = std::max({part.box.low.x, -part.box.high.x, 0.0});
        const double z = std::max({part.box.low.z, -part.box.high.z, 0.0});
        return part.box.high.y < low || part.box.low.y > high || std::hypot(x, z) > radius;
    });
    return near;
}

Obstacles Obstacles::in_swing_of(const Bvh& tool, double height) const {
    const Aabb box = tool.box();
    const double reach = std::hypot(std::max(-box.low.x, box.high.x), std::max(-box.low.z, box.high.z));
    Obstacles met = near_axis(reach, height + box.low.y, height + box.high.y);
    std::erase_if(met.parts_, [&](const Part& part) {
        return !may_cross_at_any_angle(*part.tree, tool, from_joint_, height);
    });
    return met;
}

double Obstacles::top() const {
    double top = -std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) top = std::max(top, part.box.high.y);
    return top;
}

std::uint32_t Obstacles::first_hit_by(const Bvh& tool, const RigidMotion& pose) const {
    const RigidMotion placed = in_tree_frame(pose);
    for (const Part& part : parts_)
        if (const auto hit = first_crossing(*part.tree, tool, placed))
            return part.tree->triangles()[*hit].part;
    return no_part;
}

bool Obstacles::may_be_hit(const Bvh& tool, const RigidMotion& pose, const Sweep& sweep) const {
    const RigidMotion placed = in_tree_frame(pose);
    const Sweep turned{sweep.turn, from_joint_.turn * sweep.slide};
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const Part& part) { return may_cross(*part.tree, tool, placed, turned); });
}

}  // namespace bolt::geometry
