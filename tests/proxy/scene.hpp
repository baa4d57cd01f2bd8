// Test scenes for the god-object: obstacles with exact distances, and a contact query over them.
#pragma once

#include <algorithm>
#include <span>
#include <variant>
#include <vector>

#include "engine/base/random.hpp"
#include "haptics/proxy/god_object.hpp"

namespace bolt::test {

using namespace bolt::collision;
using namespace bolt::proxy;

struct HalfSpace {
    Vec3 normal{0, 0, 1};  // away from the solid
    double offset = 0.0;   // normal · x on the surface
};
struct Ball {
    Vec3 centre{0.0};
    double radius = 0.0;
    collision::ObstacleId obstacle = collision::ObstacleId::fixed(0);
};
struct Box {
    Pose pose;
    Vec3 half{0.0};
};
struct Rod {  // with round ends
    Vec3 a{0.0}, b{0.0};
    double radius = 0.0;
};
using Obstacle = std::variant<HalfSpace, Ball, Box, Rod>;

struct Closest {
    Vec3 point{0.0};
    Vec3 normal{0, 0, 1};
    double distance = 0.0;
};

Closest closest(const Obstacle& obstacle, const Vec3& to);

// Obstacles and a tool. The tool consists of points and of boxes; boxes are tested against pins (points,
// edges and round pins of the obstacles), which the points miss.
struct Scene {
    std::vector<Obstacle> obstacles;
    std::vector<Ball> pins;
    std::vector<Vec3> points;
    std::vector<Box> parts;
    // Report only the nearest obstacle of each point, as a query over one mesh does.
    bool nearest_only = false;
    mutable int looks = 0;

    ContactQueryResult operator()(const Pose& pose, double band, std::span<Contact> contacts) const;
};

// m; exact minimum over the scene. Negative: penetration.
double clearance(const Scene& scene, const Pose& pose);

// Adds points on the faces of a box, edges and corners included, at most `spacing` (m) apart.
void add_box(Scene& scene, const Box& box, double spacing);

// Adds the box's twelve edges as pins of zero radius, at most `spacing` (m) apart.
void add_edges_as_pins(Scene& scene, const Box& box, double spacing);

inline Vec3 any_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
}

}  // namespace bolt::test
