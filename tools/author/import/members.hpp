// What a bolt clamps: the parts between head and nut, and how thick they are there.
#pragma once

#include <vector>

#include "tools/author/import/fasteners.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

// What is known of each part of the document.
struct PartGeometry {
    PartMesh mesh;
    FastenerShape fastener;
    std::vector<Hole> holes;
};

struct ClampedMember {
    int node = -1;           // of the tree; −1: nothing was found there
    double thickness = 0.0;  // m
};

// A bolt in its place; heights along the axis of what stands at the head's and at the nut's side of the
// members.
struct Clamping {
    Vec3 origin, axis;
    double diameter = 0.0;
    double head = 0.0, seat = 0.0;
};

inline constexpr double coaxial_distance = 0.1 * mm;

// Axes within 0.1 mm and 0.5° of each other: the point q is that near to the first axis.
bool coaxial(const Vec3& p, const Vec3& a, const Vec3& q, const Vec3& b);

// From head to nut. `parts` and `poses` by node; null: no member. Where the parts around the bolt leave a
// gap, what closes it elsewhere counts: the raised faces of two flanges and the gasket between them.
std::vector<ClampedMember> find_members(const std::vector<const PartGeometry*>& parts,
                                        const std::vector<Placement>& poses, const Clamping& bolt);

}  // namespace bolt::step_import
