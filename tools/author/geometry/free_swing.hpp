// The angles through which a tool can swing about a bolt without a collision.
#pragma once

#include <utility>
#include <vector>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/obstacles.hpp"

namespace bolt::geometry {

// A collision-free range of handle angles about +Y.
struct Arc {
    double from = 0.0, to = 0.0;                      // rad, from < to
    std::uint32_t before = no_part, after = no_part;  // parts that limit the range at `from` and at `to`

    [[nodiscard]] double width() const { return to - from; }
};

// A range of handle angles, accurate to a degree, in which the same part collides with the tool.
struct BlockedArc {
    double from = 0.0, to = 0.0;  // rad, from < to
    std::uint32_t part = no_part;
};

// The free arcs of one revolution of a tool on a joint.
struct FreeSwing {
    std::vector<Arc> arcs;             // in the order of their angles; empty: the tool fits at no angle
    std::vector<BlockedArc> blocked;   // in the order of their angles
    std::uint32_t blocking = no_part;  // the part that collides at the most angles

    [[nodiscard]] const Arc* widest() const;  // nullptr without an arc
    [[nodiscard]] double width() const;       // rad, of the widest arc
};

// `tool` as from place_on_joint(), its origin `height` m above the joint's.
FreeSwing find_free_swing(const Obstacles& surroundings, const Bvh& tool, double height);

// Returns true if the intervals [from, to], taken modulo `period`, cover the whole period.
bool covers_period(std::vector<std::pair<double, double>> intervals, double period);

}  // namespace bolt::geometry
