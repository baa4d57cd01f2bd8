// Annotations in the scene: arrows that show a motion, straight or about an axis, and labels with the values
// of a joint.
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

// Generates two meshes in the order of ArrowShape. Straight: from the origin to 1 along +Z. Round: about +Z
// at radius 1, from +X by `arrow_sweep`, counter-clockwise seen from +Z.
assets::Model arrow_model();
inline constexpr double arrow_sweep = to_radians(75.0);

struct MotionArrow {
    ArrowShape shape = ArrowShape::straight;
    glm::dmat4 world{1.0};  // from the mesh's frame to the assembly's
    glm::vec4 color{1.0F};
};

// From `from` to `to`, m, in the assembly's frame. The thickness is proportional to the length.
MotionArrow straight_arrow(const Vec3& from, const Vec3& to, const glm::vec4& color);

// An arc about `axis` (unit) through `middle`, right-handed. It begins in the direction of `from`, which need
// not be perpendicular to the axis but must not be parallel to it.
struct ArrowArc {
    Vec3 middle{0.0}, axis{0.0, 1.0, 0.0}, from{1.0, 0.0, 0.0};
    double radius = 0.1;  // m
};
MotionArrow round_arrow(const ArrowArc& arc, const glm::vec4& color);

// Replaces the displayed arrow of this meaning by `arrow`, with an outline that is visible through other
// parts. An empty `arrow` hides it.
void show_arrow(SceneWorld& world, const std::optional<MotionArrow>& arrow,
                ArrowMeaning meaning = ArrowMeaning::motion);

// The arrow of a force (N) on the hand at `at` (m, assembly frame): it begins there, and its length is
// proportional to the force. None for a force that is too small to see.
std::optional<MotionArrow> force_arrow(const Vec3& at, const Vec3& force);
inline constexpr double force_arrow_length = 0.012;  // m/N
inline constexpr double min_arrow_force = 0.4;       // N

// The components that work_label() reads.
using WorkAccess = ecs::Access<const world::Joint, const world::ToolState, const world::WorkingHand>;

inline constexpr glm::vec4 label_color{0.95F, 0.96F, 0.97F, 1.0F};

// A text on a plate whose lower edge is at the position (m). `height`: px, at every distance. Visible through
// other parts.
render::Label plate_label(std::string text, const Vec3& position, float height);

// The position above a nut for its labels, m.
Vec3 label_position(const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                    std::size_t joint);

// The label at the engaged nut; none if no nut is engaged. With the fingers it shows the turns; with a wrench
// the torque, the angle and the stage. Except in an assessment, the torque has the colour and symbol of its
// verdict. The angle counts from the mark; without a mark, from the start of the step, and only if the joint
// is due. In a step that turns the nut by an angle, the step's angle and the verdict on it are shown.
std::optional<render::Label> work_label(const words::Words& words, const lesson::Lesson& lesson,
                                        const servo::Setup& setup, const WorkAccess& world,
                                        const view::Palette& palette = {});

// The force of the hand on the wrench's handle, N, above the wrist; none without an engaged wrench.
std::optional<render::Label> pull_label(
    const words::Words& words, const servo::Setup& setup,
    const ecs::Access<const world::Joint, const world::ToolState, const world::WorkingHand,
                      const world::ConstrainedTool>& world);

// The name and the clamp force of a joint.
render::Label clamp_label(const words::Words& words, const content::Assembly& assembly,
                          const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                          std::size_t joint);

}  // namespace bolt::scene
