// How much of a body an eye sees past all the others: for the choice of a view, and for who has to reach for
// what cannot be seen. Rays, not pictures, so it costs the same wherever the picture is drawn.
#pragma once

#include <vector>

#include "haptics/contact/world.hpp"

namespace bolt::contact {

// Of a surface, in the frame of its body.
struct Spot {
    Vec3 at{0.0};       // m
    Vec3 normal{0.0};   // unit, outward
    double area = 0.0;  // m² that it stands for
};

// Spots spread evenly over a mesh, by area. The same for the same mesh.
std::vector<Spot> spread_spots(const ContactMesh& mesh, std::size_t count);

// Of these the ones that face away from the body: none of a bore, which its bolt fills.
std::vector<Spot> outer_spots(const Solid& solid, std::size_t count);

struct Seen {
    double share = 0.0;  // 0…1 of what would be seen if the body stood alone; 0 if nothing would be
    double angle = 0.0;  // sr of it that are seen
};

// Of the body with this index, as the world stands now. Bodies that are off hide nothing; the body itself may
// be off. With n spots the share is good to about 1/√n.
Seen look_at(const World& world, std::size_t body, std::span<const Spot> spots, const Vec3& eye);

// The same of something that is not in the world: a tool in the hand.
Seen look_at(const World& world, const Solid& solid, const Pose& pose, std::span<const Spot> spots,
             const Vec3& eye);

}  // namespace bolt::contact
