// An open-end wrench as triangles: the author's model of it or, without one, an envelope of plausible
// proportions. Tool frame: origin in the middle of the jaw at mid thickness, +X along the handle, +Z normal
// to the flat; the mouth of the jaw opens at -X, turned by the head angle about Z.
#pragma once

#include <limits>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

// Proportions of the envelope over the jaw's opening, near those of forged double-ended wrenches (DIN 3110:
// 24 mm has a head of 50 to 52 mm, 10 to 11 mm thick). One thickness for all of it is on the safe side.
inline constexpr double head_width_ratio = 2.1;
inline constexpr double thickness_ratio = 0.45;
inline constexpr double handle_width_ratio = 0.85;
inline constexpr double jaw_depth_ratio =
    0.6;  // from the middle of the jaw to its bottom; the hexagon needs 0.577
inline constexpr double handle_beyond_grip = 1.12;  // overall length over jaw to middle of grip

struct Wrench {
    std::string name = "the wrench";  // in what is said of it

    std::vector<Triangle> triangles;  // in the tool frame, metres
    double head_angle = 0.0;          // rad, of the jaw to the handle, about +Z
    double head_size = 0.0;           // m, from the middle of the jaw to the outside of the head
    double half_thickness = 0.0;      // m, of the head
    double reach = 0.0;               // m, of what is furthest from the middle of the jaw
};

Wrench plain_wrench(const content::WrenchDesign& design);

// The wrench of a model, with what its jaw measures held against the design; a model may lie flat (Y normal
// to the flat, as import-step turns it) or stand (Z).
Result<Wrench> model_wrench(const Scene& scene, const content::WrenchDesign& design);

// The wrench on a nut whose axis is +Y, its handle along +X; turned over, its head points to the other side.
Bvh posed(const Wrench& wrench, bool turned_over);

// How far a wrench that is on a nut can swing about the nut's axis before it touches something.

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

// Whether a wrench that fits on a nut can be brought there: lifted off along the bolt, or drawn off sideways.

struct Approach {
    double height = 0.0;     // of the wrench on the nut, above the joint's origin
    double jaw_angle = 0.0;  // of the jaw to the handle, rad about +Y
    double head_size = 0.0;  // m
    double reach = 0.0;      // m, of the wrench
};

// What is in the way of every path from every free angle; no_part: there is a path.
std::uint32_t blocked_by(const Bvh& surroundings, const Bvh& wrench, const Swing& swing,
                         const Approach& approach);

}  // namespace bolt::geometry
