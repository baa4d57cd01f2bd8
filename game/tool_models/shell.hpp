// Closed triangle meshes that are built from loops of points: lofts, plates with rounded edges and turned
// parts. The triangles are counterclockwise seen from outside, and each edge has two of them. Millimetres.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::tool_models {

using Vec2 = glm::dvec2;

struct Shell {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

// A closed curve; counterclockwise as seen against the direction in which a loft advances.
using Loop = std::vector<Vec3>;

// Joins loops of equal size in their order and closes both ends with caps.
Shell loft(const std::vector<Loop>& loops);

// The same without caps: the last loop is joined to the first, as in a torus.
Shell closed_loft(const std::vector<Loop>& loops);

// Returns the triangles of a simple polygon whose corners are counterclockwise.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec2> polygon);

// A point of an outline, and the radius by which the edges of both faces are rounded there.
struct OutlinePoint {
    Vec2 at{0.0};
    double edge = 0.0;
};

// Appends an arc from angle `from` to angle `to` (rad), both ends included. `steps`: number of chords.
void add_arc(std::vector<OutlinePoint>& outline, const Vec2& middle, double radius, double from, double to,
             int steps, double edge);

// A plate over a counterclockwise outline, from z = `low` to `high`. `steps`: chords of a rounded edge.
Shell plate(std::span<const OutlinePoint> outline, double low, double high, int steps);

// A rectangular plate with rounded corners and edges.
Shell block(const Vec3& low, const Vec3& high, double corner, double edge, int steps);

// Returns the distance of a point of a turned part from its axis. `angle`: of the point about the axis, rad;
// `radius`: of the profile there.
using RadiusOfAngle = std::function<double(double angle, double radius)>;

// A point of a turned part's profile: along the axis and from the axis. `shape` replaces the circle.
struct ProfilePoint {
    double along = 0.0, radius = 0.0;
    RadiusOfAngle shape = {};
};

// Parts that are turned about Z or X; closed_lathe_z() joins the end of the profile to its beginning. If a
// profile is drawn with the axis upwards and the radius to the right, the solid lies to the left of the
// profile's direction. So a profile runs up the outside, over the rim and down the bore.
Shell lathe_z(std::span<const ProfilePoint> profile, int segments);
Shell lathe_x(std::span<const ProfilePoint> profile, int segments);
Shell closed_lathe_z(std::span<const ProfilePoint> profile, int segments);

// Radii of regular profiles. The argument `radius` is half the width across flats.
double hexagon_radius(double angle, double radius);
double twelve_point_radius(double angle, double radius);  // two hexagons, 30° apart
double square_radius(double angle, double radius);

// Maps each point of a shell. The map must not mirror, or the triangles would face inwards.
Shell moved(Shell shell, const std::function<Vec3(const Vec3&)>& map);

// The volume, in the cube of the shell's unit of length; positive if the triangles face outwards.
double volume(const Shell& shell);

}  // namespace bolt::tool_models
