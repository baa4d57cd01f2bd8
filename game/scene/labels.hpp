// Figures that stand in the scene, at the place that they belong to.
#pragma once

#include "content/words/words.hpp"
#include "engine/render/label.hpp"
#include "game/lesson/lesson.hpp"
#include "game/view/palette.hpp"
#include "game/world/haptics.hpp"

namespace bolt::scene {

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
