// Finds the parts that a bolt clamps between head and nut, and their thickness along the bolt.
#pragma once

#include <optional>
#include <vector>

#include "tools/author/import/fasteners.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

// Geometry of one part of the document.
struct PartGeometry {
    PartMesh mesh;
    FastenerShape fastener;
    std::vector<Hole> holes;
};

struct ClampedMember {
    int node = -1;           // of the tree; −1: no part was found
    double thickness = 0.0;  // m
};

// A bolt in the scene frame, metres. The functions below examine the parts between the heights `head` and
// `end` along the axis from `origin`.
struct InstalledBolt {
    Vec3 origin, axis;
    double diameter = 0.0;
    double head = 0.0;  // under the head and its washers
    // For find_members(): under the nut and its washers, or at the tapped part. For find_tapped_part(): the
    // end of the bolt.
    double end = 0.0;
};

inline constexpr double coaxial_distance = 0.1 * mm;
inline constexpr double touching = 0.06 * mm;  // largest gap of faces that count as in contact

// Returns true if the lines through p along a and through q along b differ by at most 0.1 mm at q and 0.5° in
// direction.
bool coaxial(const Vec3& p, const Vec3& a, const Vec3& q, const Vec3& b);

// Returns the members from the head to `bolt.end`, which is the height under the nut and its washers, or that
// of the tapped part. `parts` and `poses` are indexed by node; a null part is ignored. A gap between two
// members at the bolt is filled by the parts that close the gap elsewhere, such as the raised faces of two
// flanges and the gasket between them.
std::vector<ClampedMember> find_members(const std::vector<const PartGeometry*>& parts,
                                        const std::vector<ScaledPose>& poses, const InstalledBolt& bolt);

// A part with a hole that a bolt is screwed into. Heights along the bolt's axis, m.
struct TappedPart {
    int node = -1;
    double hole = 0.0;                // diameter, m
    double face = 0.0, bottom = 0.0;  // heights at which the material around the hole begins and ends
    bool nominal = false;             // the hole is as wide as the thread
};

// Returns the part that the end of a bolt without a nut is screwed into. The hole of this part is as wide as
// the core of the bolt's thread, and the bolt engages by at least half a diameter. A hole as wide as the
// whole thread counts too, unless the bolt protrudes by more than 0.3 diameters: such a bolt has probably
// lost its nut. If there are several such parts, returns the last one along the bolt. `bolt.end` is the end
// of the bolt.
std::optional<TappedPart> find_tapped_part(const std::vector<const PartGeometry*>& parts,
                                           const std::vector<ScaledPose>& poses, const InstalledBolt& bolt);

}  // namespace bolt::step_import
