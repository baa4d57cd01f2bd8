// What a facetted mesh stands for: a bar or a rounded edge is round, and a hand that slides along it must not
// count its facets. Near the surface a contact's `smooth` normal goes on evenly from facet to facet, as
// shading does with light (force shading: Morgenbesser and Srinivasan, ASME DSC-58, 1996; Ruspini, Kolarov
// and Khatib, SIGGRAPH 1997). Distances stay those of the facets, so nothing is entered that was not before.
#pragma once

#include "haptics/contact/proximity.hpp"

namespace bolt::contact {

// Full up to `near`, which is more than a skin (god_object.hpp), none from `far` on, m: planes further off
// would be tilted for nothing.
inline constexpr double smooth_near = 0.16e-3, smooth_far = 0.36e-3;
// No further from the facets' own normal than this, rad.
inline constexpr double most_smoothed = 20.0 * pi / 180.0;

// Gives contacts that `find_contacts` wrote for this world, tool and pose their smooth normals. Where a face
// or a blunt edge is met by a crease, its normal counts; of two smooth ones rather that of the flatter; where
// creases meet, the normal is as it was.
void smooth_normals(const World& world, const ToolShape& tool, const Pose& pose, std::span<Contact> contacts);

}  // namespace bolt::contact
