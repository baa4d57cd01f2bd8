// Figures that stand in the scene, at the place that they belong to.
#pragma once

#include "content/format/assembly.hpp"
#include "engine/render/label.hpp"
#include "game/lesson/plan.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::scene {

inline constexpr glm::vec4 due_color{1.0F, 0.78F, 0.1F, 1.0F}, label_color{0.95F, 0.96F, 0.97F, 1.0F};

// A plate with a text, its lower edge at the point; equally high at every distance, through whatever hides
// it.
render::Label plate(std::string text, const Vec3& at, float height);

// Above a nut, where its name stands.
Vec3 above_nut(const servo::Setup& setup, const servo::State& state, std::size_t joint);

// Torque, angle and stage at the wrench, in the colour of how the torque lies to what is asked for; turns by
// hand. None: nothing is held.
std::optional<render::Label> work_label(const content::Assembly& assembly, const servo::Setup& setup,
                                        const servo::State& state, const servo::Output& output,
                                        const lesson::Step* due, bool wrench);

// Clamp force of a joint, and its share of what the joint is designed for.
render::Label clamp_label(const content::Assembly& assembly, const servo::Setup& setup,
                          const servo::State& state, std::size_t joint);

}  // namespace bolt::scene
