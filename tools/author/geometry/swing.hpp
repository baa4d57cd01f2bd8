// How far a wrench that is on a nut can swing about the nut's axis before it touches something.
#pragma once

#include <limits>
#include <vector>

#include "tools/author/geometry/crossing.hpp"

namespace bolt::geometry {

inline constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

// Angles of the handle, rad, at which nothing is touched: from < to. What stops it at either end.
struct Arc {
    double from = 0.0, to = 0.0;
    std::uint32_t before = no_part, after = no_part;

    [[nodiscard]] double width() const { return to - from; }
};

// All free arcs of a turn, by angle; none: it fits nowhere, and `blocking` is what is most in the way.
struct Swing {
    std::vector<Arc> arcs;
    std::uint32_t blocking = no_part;

    [[nodiscard]] const Arc* widest() const;  // nullptr: there is none
};

// `wrench` on the nut's axis +Y with its handle along +X, `height` above the joint's origin.
Swing free_swing(const Bvh& surroundings, const Bvh& wrench, double height);

// Angles [from, to], taken modulo `period`, leave no gap.
bool cover(std::vector<std::pair<double, double>> intervals, double period);

}  // namespace bolt::geometry
