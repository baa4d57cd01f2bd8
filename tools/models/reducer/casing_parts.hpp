// What both halves of the casing are put together from. Everything reaches a little beyond the parting plane
// (to `overlap` on its far side) and is cut off there at the end, so that no rounding ends on it.
#pragma once

#include <TopoDS_Shape.hxx>
#include <span>

#include "tools/models/reducer/casing.hpp"
#include "tools/models/reducer/layout.hpp"
#include "tools/models/reducer/shapes.hpp"

namespace bolt::models::reducer {

inline constexpr double overlap = 12.0;

// The half-space y > 0 or a side of the parting plane, as a box larger than the reducer.
TopoDS_Shape half_space_y();
TopoDS_Shape half_space_z(bool upper);

// The shell of a half as a solid: the hull of the contour's circles drawn in by `inset`, of a half width at
// the parting plane, all sides leaning in by the draft, the edges rounded.
TopoDS_Shape housing(std::span<const Circle> contour, double inset, double half, double radius);

// Upper half, y > 0 only: flange, bearing bosses and bolt bosses blended onto the wall, mirrored for the
// lower half.
TopoDS_Shape flange_half(double grown);
TopoDS_Shape bearing_boss(const ShaftPlace& shaft, double grown);
TopoDS_Shape bolt_boss(const JointPlace& joint, double grown);
TopoDS_Shape side_bosses(const TopoDS_Shape& body, double grown);
bool on_rim(
    const TopoDS_Edge& edge);  // where the halves were cut off: in the plane of symmetry or at the overlap

// A rib of a thickness across x, its outline given in (y, z), the free edges rounded.
TopoDS_Shape rib(double x, double thickness, const std::vector<std::pair<double, double>>& outline);

// An eye or a hook to lift by, in the plane y = 0: an outline in (x, z) made 20 thick with rounded edges.
TopoDS_Shape lug(const TopoDS_Wire& outline_at_minus_10);

// Bores of the bearing seats, bolt holes with their spot faces, dowel and cap screw holes.
Shapes machining(bool upper);

// The faces of a finished half that a tool has cut.
std::vector<FaceFinish> machined_faces(const TopoDS_Shape& shape);

}  // namespace bolt::models::reducer
