// Instances of recognised fasteners at their places in the scene, which the search for joints pairs.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"
#include "tools/author/import/fasteners.hpp"
#include "tools/author/import/tree.hpp"

namespace bolt::step_import {

// An instance of a fastener, scene frame. Its sizes include the scale of the instance.
struct PlacedFastener {
    FastenerKind kind = FastenerKind::none;
    int node = -1;
    Vec3 origin{0.0}, axis{0.0, 1.0, 0.0};
    double across_flats = 0.0, low = 0.0, high = 0.0, diameter = 0.0;  // m, as in FastenerShape
    std::optional<CapHead> cap = {};
    // As in FastenerShape. Measured in the part's own frame, because CAD may mirror an instance, but real
    // bolts are not mirrored.
    std::optional<joint::ThreadDirection> drawn_thread = {};
};

PlacedFastener place(int node, const FastenerShape& shape, const ScaledPose& pose);

// The same fastener with the opposite axis.
PlacedFastener reversed(PlacedFastener placed);

// The metric size of a bolt or a stud; null if it has none. explain_metric_size() gives the reason for a
// bolt.
const joint::FastenerSize* metric_size_of(const PlacedFastener& bolt);
std::string explain_metric_size(const PlacedFastener& bolt);

// Returns true if the nut has the width of one for this bolt or stud.
bool nut_fits(const PlacedFastener& bolt, const PlacedFastener& nut);

// "looks like a bolt (…)", with its measures.
std::string describe(const PlacedFastener& bolt);

// Lower and upper face of a fastener as heights along the line from `origin`, m.
std::pair<double, double> along(const PlacedFastener& placed, const Vec3& origin, const Vec3& axis);

double distance_from_axis(const PlacedFastener& placed, const Vec3& point);

// Returns true for the names that CAD programs and people give to bolts, nuts and studs.
bool named_like_fastener(const std::string& name);

}  // namespace bolt::step_import
