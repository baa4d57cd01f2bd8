// Recognises bolts, nuts, washers and studs by their shape alone (a hexagon of six flats, a cylindrical head
// with a hexagonal socket, a ring, a rod as thick as a metric thread), and finds holes.
#pragma once

#include <TopoDS_Shape.hxx>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/design.hpp"
#include "tools/author/import/metric_size.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

// Many rods that are no studs look like one; a nut and a tapped hole decide.
enum class FastenerKind { none, bolt, nut, washer, stud };

// Scene frame, metres, relative to the part. Heights are measured along the axis from `origin`.
struct FastenerShape {
    FastenerKind kind = FastenerKind::none;
    Vec3 origin{0.0}, axis{0.0, 1.0, 0.0};  // of a bolt: from the head to the end; of a stud: either way
    double across_flats = 0.0;              // of the hexagon, or of a cap screw's socket
    double low = 0.0;       // bearing face under a bolt's head; lower face of a nut or washer; end of a stud
    double high = 0.0;      // end of a bolt; upper face of a nut or washer; other end of a stud
    double diameter = 0.0;  // of a thread over the crests; of the hole of a nut or washer
    // Why a part that resembles a fastener was not recognised as one: "<what was found>; expected <what>".
    // Empty for a fastener and for a part that does not resemble one.
    std::string rejection;
    // The same for a part without a hexagon; reported only if the name is that of a fastener.
    std::string without_hexagon;
    std::optional<CapHead> cap = {};  // the head of a cap screw
    // The direction of the drawn helix of a bolt or a stud; none if no helix is drawn.
    std::optional<joint::ThreadDirection> drawn_thread = {};
};

FastenerShape recognise_fastener(const TopoDS_Shape& shape, const PartMesh& mesh);

// A cylindrical hole. Scene frame, metres, relative to the part.
struct Hole {
    Vec3 point, axis;
    double radius = 0.0;
};

std::vector<Hole> find_holes(const TopoDS_Shape& shape);

// Returns the sorted parameters t at which the line origin + t · direction enters and leaves the closed mesh.
std::vector<double> crossings(const PartMesh& mesh, const Vec3& origin, const Vec3& direction);

}  // namespace bolt::step_import
