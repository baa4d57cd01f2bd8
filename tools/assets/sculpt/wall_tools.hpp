// Tools that hang on the board: shapes enough to be known at three metres.
#pragma once

#include "tools/assets/sculpt/solid.hpp"

namespace bolt::sculpt {

// Hanging down from `peg`, flat against the plane z = peg.z.
void hang_spanner(Solid& out, const Vec3& peg, double across_flats_mm);
void hang_hammer(Solid& out, const Vec3& peg);
void hang_screwdriver(Solid& out, const Vec3& peg, double length);

}  // namespace bolt::sculpt
