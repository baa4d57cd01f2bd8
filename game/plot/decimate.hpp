// Fewer points for the same picture. Highest and lowest points are never lost.
#pragma once

#include <span>
#include <vector>

#include "game/plot/svg.hpp"

namespace bolt::plot {

// Of each run of points that falls into one column `column` wide, the first, lowest, highest and last (the M4
// rule: Jugel et al., VLDB 2014). A NaN ends a run and is kept. Order is kept.
std::vector<Point> decimate(std::span<const Point> points, double column);

// The points within [low, high] in x, and the neighbour on either side of each stretch: what a clipped line
// needs.
std::vector<Point> within(std::span<const Point> points, Range x);

}  // namespace bolt::plot
