// The free and the blocked directions of a tool as flat sectors around a nut.
#pragma once

#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/geometry/free_swing.hpp"

namespace bolt::author {

// The ring in which the sectors lie, m: its inner and outer radius and its height above the joint's origin.
struct FanRing {
    double inner = 0.0, outer = 0.0, height = 0.0;
};

// The meshes of the model, in this order; a mesh without sectors has no triangles.
enum class FanMesh : std::uint8_t { free, free_rim, blocked, blocked_rim };
inline constexpr std::size_t fan_meshes = 4;

// The sectors in the joint's frame, a node for each mesh. Both sides of each sector can be seen.
assets::Model make_swing_fan(const geometry::FreeSwing& swing, const FanRing& ring);

// The point of the ring's plane at an angle about +Y and a distance from the axis.
Vec3 fan_point(double angle, double radius, double height);

}  // namespace bolt::author
