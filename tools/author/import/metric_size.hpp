// The metric size of a bolt from its measured dimensions, in metres.
#pragma once

#include <string>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::step_import {

inline constexpr double flats_slack = 0.5 * mm;  // tolerance of the width across flats

// Returns the metric size that has this diameter over the crests and this width across flats, by ISO 272 or
// by DIN 931; null if there is none.
const joint::FastenerSize* size_of(double diameter, double across_flats);

// Explains why size_of() returns null for a bolt of this diameter: what is expected, and the inch thread of
// this diameter, if there is one.
std::string explain_size(double diameter);

// Returns the name of the thread. `hole`: diameter of the hole of the nut or tapped part, m, which reveals a
// fine pitch by D1 = d − 1.0825 P (ISO 68-1). Without a match the pitch is coarse.
std::string thread_name(const joint::FastenerSize& size, double hole);

}  // namespace bolt::step_import
