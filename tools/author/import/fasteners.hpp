// Recognises bolts, nuts and washers by their shape alone: a hexagon of six flats, a ring.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

enum class FastenerKind { none, bolt, nut, washer };

// Scene frame, metres, relative to the part. Heights are counted along the axis from `origin`.
struct FastenerShape {
    FastenerKind kind = FastenerKind::none;
    Vec3 origin{0.0}, axis{0.0, 1.0, 0.0};  // of a bolt: from its head to its end
    double across_flats = 0.0;
    double low = 0.0;       // bearing face under a bolt's head; lower face of a nut or washer
    double high = 0.0;      // end of a bolt; upper face of a nut or washer
    double diameter = 0.0;  // of a bolt's thread over its crests; of the hole of a nut or washer
    // Why a part is no fastener although it resembles one: "what was found; expected what". Empty if it is a
    // fastener or resembles none.
    std::string rejection;
    std::string
        without_hexagon;  // the same for a part without a hexagon, of interest if its name is a fastener's
};

FastenerShape recognise_fastener(const TopoDS_Shape& shape, const PartMesh& mesh);

// A cylindrical hole, for finding what a bolt goes through.
struct Hole {
    Vec3 point, axis;
    double radius = 0.0;
};

std::vector<Hole> find_holes(const TopoDS_Shape& shape);

// Where a straight line goes into and out of the closed mesh, in order; t counts lengths of `direction`.
std::vector<double> crossings(const PartMesh& mesh, const Vec3& origin, const Vec3& direction);

}  // namespace bolt::step_import
