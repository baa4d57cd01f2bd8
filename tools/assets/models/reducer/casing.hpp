// The two halves of the cast casing, and the shapes from which they are assembled.
#pragma once

#include <TopoDS_Shape.hxx>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/assets/models/document.hpp"
#include "tools/assets/models/reducer/layout.hpp"
#include "tools/assets/models/reducer/shapes.hpp"

namespace bolt::models::reducer {

struct Casting {
    TopoDS_Shape shape;
    std::vector<FaceFinish> machined;  // faces cut by a tool, which carry no paint
};

Result<Casting> casing_upper();
Result<Casting> casing_lower();

// Every shape extends beyond the parting plane by `overlap` and is cut off there at the end, so that no
// rounding ends on the plane.
inline constexpr double overlap = 12.0;

// The half-space y > 0, or one side of the parting plane, as a box larger than the reducer.
TopoDS_Shape half_space_y();
TopoDS_Shape half_space_z(bool upper);

// The outside of a half as a solid: the hull of the contour's circles, offset inward by `inset`. `half` is
// its half width at the parting plane; all sides are inclined by the draft; the edges are rounded by
// `radius`.
TopoDS_Shape housing(std::span<const ContourCircle> contour, double inset, double half, double radius);

// Shapes of the upper half at y > 0; the lower half mirrors them. All are offset outward by `grown`.
TopoDS_Shape flange_half(double grown);
TopoDS_Shape bearing_boss(const ShaftLayout& shaft, double grown);
TopoDS_Shape bolt_boss(const JointLayout& joint, double grown);
TopoDS_Shape side_bosses(const TopoDS_Shape& body, double grown);  // the body with all its bosses
// Returns whether an edge lies where the shape is cut off later: in the plane y = 0 or at z = −overlap.
bool on_rim(const TopoDS_Edge& edge);

// A rib in the plane x = const: its outline is given in (y, z), its free edges are rounded.
TopoDS_Shape rib(double x, double thickness, const std::vector<std::pair<double, double>>& outline);

// A lifting eye or hook in the plane y = 0: the outline, given at y = −10, extruded to a thickness of 20,
// with rounded edges.
TopoDS_Shape lug(const TopoDS_Wire& outline_at_minus_10);

// The shapes to cut away: bores of the bearing seats, bolt holes with their spot faces, dowel and cap screw
// holes.
Shapes machining(bool upper);

// The faces of a finished half that machining() has cut.
std::vector<FaceFinish> machined_faces(const TopoDS_Shape& shape);

}  // namespace bolt::models::reducer
