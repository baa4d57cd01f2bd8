// Arrows that show a motion in the scene: straight ones and ones about an axis. Their model is made here, of
// no file.
#pragma once

#include <optional>

#include "engine/assets/model.hpp"
#include "engine/base/pose.hpp"
#include "game/scene/components.hpp"

namespace bolt::scene {

// Two meshes in the order of ArrowShape. Straight: from the origin to 1 along +Z. Round: about +Z at radius
// 1, from +X on by `arrow_sweep`, counter-clockwise seen from +Z.
assets::Model arrow_model();
inline constexpr double arrow_sweep = to_radians(75.0);

struct Arrow {
    ArrowShape shape = ArrowShape::straight;
    glm::dmat4 world{1.0};  // from its mesh to the assembly
    glm::vec4 color{1.0F};
};

// m, in the assembly's frame; it is as thick as it is long.
Arrow straight_arrow(const Vec3& from, const Vec3& to, const glm::vec4& color);

// About the axis (unit) through `middle`, right-handed; it begins on the side of `from`, which need not be
// square to the axis but must not lie along it.
struct Turn {
    Vec3 middle{0.0}, axis{0.0, 1.0, 0.0}, from{1.0, 0.0, 0.0};
    double radius = 0.1;  // m
};
Arrow round_arrow(const Turn& turn, const glm::vec4& color);

// The one arrow there is, with a line around it that shows through what hides it; none takes it away.
void show_arrow(World& world, const std::optional<Arrow>& arrow);

}  // namespace bolt::scene
