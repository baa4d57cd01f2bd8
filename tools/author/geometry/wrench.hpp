// An open-end wrench as triangles: the author's model of it or, without one, an envelope of plausible
// proportions. Tool frame: origin in the middle of the jaw at mid thickness, +X along the handle, +Z normal
// to the flat; the mouth of the jaw opens at -X, turned by the head angle about Z.
#pragma once

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

}  // namespace bolt::geometry
