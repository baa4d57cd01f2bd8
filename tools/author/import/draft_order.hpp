// The order in which a drafted assembly tightens joints of one tool.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::step_import {

// Returns indices into `seats` (m). Joints on a circle are tightened in a star: the next joint is the
// farthest from all earlier ones and, among equals, the farthest from the last one. Other joints are
// tightened from the middle outwards.
std::vector<std::size_t> tightening_order(const std::vector<Vec3>& seats);

}  // namespace bolt::step_import
