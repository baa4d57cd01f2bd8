// Positions of walls relative to one another and to a point: distances, seams and crossings. All values in m.
#pragma once

#include <array>
#include <optional>

#include "content/displays/display_file.hpp"

namespace bolt::content {

// The axes of a wall; meaningless for a wall without width or height.
struct WallAxes {
    Vec3 origin{0.0};                       // the lower left corner
    Vec3 right{0.0}, up{0.0}, normal{0.0};  // unit vectors; the normal points towards the viewer
    double width = 0.0, height = 0.0;
};
WallAxes axes_of(const Wall& wall);

// The point at `x` to the right of and `y` above the lower left corner.
inline Vec3 in_room(const WallAxes& wall, double x, double y) {
    return wall.origin + x * wall.right + y * wall.up;
}

// Distance of the point in front of the wall's plane; negative behind it.
inline double distance_in_front(const WallAxes& wall, const Vec3& point) {
    return glm::dot(wall.normal, point - wall.origin);
}

// Lower left, lower right, upper right, upper left; each `margin` inside the edges.
std::array<Vec3, 4> corners_of(const WallAxes& wall, double margin = 0.0);

// Returns true if the walls have a line in common that is at least `margin` inside the edges of both.
// Parallel walls do not cross.
bool walls_cross(const WallAxes& a, const WallAxes& b, double margin);

// Detects a wall `a` that stands on the picture of `b` and so hides a part of it. If an edge of `a` lies in
// the plane of `b` and inside the outline of `b`, returns the distance of that edge from the outline. Returns
// none if no edge does, or if the distance is at most `tolerance`.
std::optional<double> edge_inset(const WallAxes& a, const WallAxes& b, double tolerance);

// The width of the strip that two walls in the same plane (to `tolerance`) have in common; none if they have
// no strip in common.
std::optional<double> coplanar_overlap(const WallAxes& a, const WallAxes& b, double tolerance);

// Returns the width of the gap between two walls. Each pair of nearly parallel edges that run side by side
// has a gap, the largest distance between them there; the result is the smallest gap, none without such a
// pair.
std::optional<double> seam_gap(const WallAxes& a, const WallAxes& b);

}  // namespace bolt::content
