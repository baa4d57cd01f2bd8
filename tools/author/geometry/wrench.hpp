// An open-end wrench as triangles (the author's model or a generated one), the angles through which it can
// swing on a nut, and the search for a free path onto the nut. Tool frame: origin in the middle of the jaw at
// mid thickness, +X along the handle, +Z normal to the flat side; the mouth of the jaw opens at -X, rotated
// by the head angle about Z.
#pragma once

#include <limits>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

struct WrenchShape {
    std::string name = "the wrench";  // used in messages
    std::vector<Triangle> triangles;  // in the tool frame, metres
    double head_angle = 0.0;          // rad, of the jaw to the handle, about +Z
    double head_size = 0.0;           // m, middle of the jaw to the outside of the head
    double half_thickness = 0.0;      // m, of the head
    double reach = 0.0;               // m, largest distance from the middle of the jaw
};

// The frame of a wrench's model: found from its flat side, which is normal to Y (as import-step writes it) or
// to Z, or the tool frame.
enum class ModelFrame : std::uint8_t { found, tool };

// The wrench of a model. Fails if the measured jaw does not agree with the design.
Result<WrenchShape> wrench_from_model(const FlattenedModel& scene, const content::WrenchDesign& design,
                                      ModelFrame frame = ModelFrame::found);

// The wrench on a nut with the axis +Y, its handle along +X. `turned_over`: rotated by 180° about the handle.
Bvh place_on_nut(const WrenchShape& wrench, bool turned_over);

inline constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

// A collision-free range of handle angles about +Y.
struct Arc {
    double from = 0.0, to = 0.0;                      // rad, from < to
    std::uint32_t before = no_part, after = no_part;  // parts that limit the range at `from` and at `to`

    [[nodiscard]] double width() const { return to - from; }
};

// A range of handle angles, to a degree, in which the same part collides with the wrench.
struct BlockedArc {
    double from = 0.0, to = 0.0;  // rad, from < to
    std::uint32_t part = no_part;
};

// The free arcs of one revolution of a wrench on a nut.
struct FreeSwing {
    std::vector<Arc> arcs;             // in the order of their angles; empty: the wrench fits at no angle
    std::vector<BlockedArc> blocked;   // in the order of their angles
    std::uint32_t blocking = no_part;  // the part that collides at the most angles

    [[nodiscard]] const Arc* widest() const;  // nullptr without an arc
};

// `wrench` as from place_on_nut(), `height` m above the joint's origin.
FreeSwing find_free_swing(const Bvh& surroundings, const Bvh& wrench, double height);

// Returns true if the intervals [from, to], taken modulo `period`, cover the whole period.
bool covers_period(std::vector<std::pair<double, double>> intervals, double period);

// Geometry of the paths by which a wrench can leave the nut: up along the bolt, or sideways out of the jaw.
struct ExitPaths {
    double height = 0.0;     // m, of the wrench on the nut above the joint's origin
    double jaw_angle = 0.0;  // rad about +Y, from the handle to the jaw
    double head_size = 0.0;  // m
    double reach = 0.0;      // m, of the wrench
};

// Returns no_part if at least one path is free, otherwise a part that blocks a path.
std::uint32_t find_obstruction(const Bvh& surroundings, const Bvh& wrench, const FreeSwing& swing,
                               const ExitPaths& paths);

}  // namespace bolt::geometry
