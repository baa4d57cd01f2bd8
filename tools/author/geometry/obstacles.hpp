// The parts that a tool on one joint may collide with.
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

inline constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

// A tree for each part of a model, in the assembly's frame.
std::vector<Bvh> build_part_trees(const FlattenedModel& scene);

class Obstacles {
  public:
    // One set of triangles in the joint's frame, which must outlive the object.
    Obstacles(const Bvh& all);  // NOLINT(google-explicit-constructor): a set of triangles is obstacles
    // The parts of a model, except those in `left_out`. `trees`: of build_part_trees(); they must outlive the
    // object.
    Obstacles(const std::vector<Bvh>& trees, const glm::dmat4& to_joint, const glm::dmat4& to_assembly,
              const std::set<std::uint32_t>& left_out);

    // The parts that may have a point within `radius` m of the joint's axis at a height (m) from `low` to
    // `high`.
    [[nodiscard]] Obstacles near_axis(double radius, double low, double high) const;

    // The parts that may have a point in the way of a tool that is turned about the axis. `height`: m, of the
    // tool's origin.
    [[nodiscard]] Obstacles in_swing_of(const Bvh& tool, double height) const;

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    [[nodiscard]] double top() const;  // m, largest height above the joint's origin; -∞ if empty

    // Returns a part with a triangle that crosses a triangle of `tool`, which `pose` places in the joint's
    // frame; no_part if there is none. If there are several, it returns the smallest, because its name
    // locates the collision better than that of a casing.
    [[nodiscard]] std::uint32_t first_hit_by(const Bvh& tool, const RigidMotion& pose) const;
    // Returns false only if the tool collides in no motion of the sweep about `pose`.
    [[nodiscard]] bool may_be_hit(const Bvh& tool, const RigidMotion& pose, const Sweep& sweep) const;

  private:
    struct Part {
        const Bvh* tree;
        Aabb box;  // in the joint's frame
    };
    [[nodiscard]] RigidMotion in_tree_frame(const RigidMotion& pose) const {
        return {from_joint_.turn * pose.turn, from_joint_(pose.shift)};
    }

    std::vector<Part> parts_;  // the smallest first
    RigidMotion from_joint_;   // to the frame of the trees
};

}  // namespace bolt::geometry
