// Arrows that show a motion in the scene: straight ones and ones about an axis. Their model is made here, of
// no file.
#pragma once

#include <optional>

#include "content/words/words.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/render/scene.hpp"
#include "game/lesson/lesson.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/labels.hpp"
#include "game/world/world.hpp"

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

// Figures that stand in the scene, at the place that they belong to.

// The components that the figures are read from.
using WorkAccess = ecs::Access<const world::Joint, const world::ToolContact, const world::Hand>;

inline constexpr glm::vec4 label_color{0.95F, 0.96F, 0.97F, 1.0F};

// A plate with a text, its lower edge at the point; equally high at every distance, through whatever hides
// it.
render::Label plate(std::string text, const Vec3& at, float height);

// Above a nut, where its name stands.
Vec3 above_nut(const servo::Setup& setup, const ecs::Access<const world::Joint>& joints, std::size_t joint);

// At the wrench: torque in the colour of how it lies to what is asked for and with its sign, the angle since
// the joint was snug (before it is, since its step began; out of its turn none), the stage; by hand the
// turns. None: nothing is held.
std::optional<render::Label> work_label(const words::Words& words, const lesson::Lesson& lesson,
                                        const servo::Setup& setup, const WorkAccess& world,
                                        const view::Palette& palette = {});

// Clamp force of a joint, with its name.
render::Label clamp_label(const words::Words& words, const content::Assembly& assembly,
                          const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                          std::size_t joint);

}  // namespace bolt::scene
