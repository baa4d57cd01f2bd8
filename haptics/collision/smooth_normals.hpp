// Smooth contact normals on facetted meshes. A bar or rounded edge is modelled by facets, and a hand that
// slides along it must not feel them. Near the surface the normal is interpolated between facets as shading
// does (force shading: Morgenbesser and Srinivasan, ASME DSC-58, 1996; Ruspini, Kolarov and Khatib, SIGGRAPH
// 1997). Distances stay those of the facets, so smoothing permits no additional penetration.
#pragma once

#include "haptics/collision/narrow_phase.hpp"

namespace bolt::collision {

// m. The full correction applies up to `smooth_near`, which exceeds GodObjectParameters::skin, and fades to
// none at `smooth_far`: tilting planes further away has no benefit.
inline constexpr double smooth_near = 0.16e-3, smooth_far = 0.36e-3;
// rad, greatest angle between the smooth normal and the facets' normal.
inline constexpr double max_smoothing_angle = 20.0 * pi / 180.0;

// Sets `Contact::smooth` of contacts that `find_contacts` wrote for this world, tool and pose. Where a face
// or blunt edge meets a crease, the face's normal is used; where two smooth surfaces meet, that of the
// flatter one; where two creases meet, `smooth` stays zero.
void smooth_normals(const CollisionWorld& world, const ToolShape& tool, const Pose& pose,
                    std::span<Contact> contacts);

}  // namespace bolt::collision
