// The visible fraction of a body from an eye point, by rays. Used to choose views and to decide what a
// simulated trainee sees. The cost does not depend on a picture's size.
#pragma once

#include <vector>

#include "haptics/collision/world.hpp"

namespace bolt::collision {

// A sample of a surface, in the frame of its body.
struct SurfacePoint {
    Vec3 at{0.0};       // m
    Vec3 normal{0.0};   // unit, outward
    double area = 0.0;  // m² that it represents
};

// Spreads `count` points over a mesh evenly by area. Deterministic.
std::vector<SurfacePoint> sample_surface(const ContactMesh& mesh, std::size_t count);

// As sample_surface, without points that face into the body: a bore is filled by its bolt.
std::vector<SurfacePoint> sample_outer_surface(const Solid& solid, std::size_t count);

struct Visibility {
    double share = 0.0;  // 0…1 of what would be visible of the body alone; 0 if that is nothing
    double angle = 0.0;  // sr, visible solid angle
};

// Visibility of the body with this index in the world's current state. Other bodies that are off hide
// nothing; the body itself may be off. With n points the error of the share is about 1/√n.
Visibility visibility_of(const World& world, std::size_t body, std::span<const SurfacePoint> points,
                         const Vec3& eye);

// The same for a solid that is not part of the world, such as a tool in the hand.
Visibility visibility_of(const World& world, const Solid& solid, const Pose& pose,
                         std::span<const SurfacePoint> points, const Vec3& eye);

}  // namespace bolt::collision
