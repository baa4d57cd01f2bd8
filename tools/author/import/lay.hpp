// The lay of a machined surface (ISO 21920: the direction of its marks), as tangents for anisotropic
// materials. The highlight of brushed metal is drawn out across the lay, so the tangent stands across it:
// along the axis of what was turned, outward on a turned face, one way on a milled one.
#pragma once

#include <TopoDS_Face.hxx>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::step_import {

// Unit tangents at the corners of a face, perpendicular to the normals; scene frame.
std::vector<Vec3> tangents_across_lay(const TopoDS_Face& face, const std::vector<Vec3>& corners,
                                      const std::vector<Vec3>& normals);

}  // namespace bolt::step_import
