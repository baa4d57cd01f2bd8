// From the pointer on a picture to what it points at in the scene, and back.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "engine/render/scene.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainer {

// A picture as it is seen: pixels from the upper left corner, y down.
struct Screen {
    render::Eye eye;
    glm::dvec2 size{1.0};
};

// Nothing for what lies behind the eye.
std::optional<glm::dvec2> project(const Screen& screen, const Vec3& point);

// The nut under the pointer: nearest in the picture, within its own size and a little more.
std::optional<std::size_t> nut_at(const Screen& screen, const glm::dvec2& pointer, const servo::Setup& setup,
                                  std::span<const Vec3> centres);

// Pixels from the pointer to the line between two points; nothing if either lies behind the eye.
std::optional<double> pixels_to(const Screen& screen, const glm::dvec2& pointer, const Vec3& from,
                                const Vec3& to);

// Pixels that the end of a handle goes on the picture for each radian that it is turned on (tightening), with
// the wrench at `tool` on a nut with this axis. Never shorter than `least_lever`: a handle that is seen end
// on would turn at a touch.
inline constexpr double least_lever = 160.0;
glm::dvec2 lever_on_screen(const Screen& screen, const Pose& tool, const Vec3& axis, double handle_length);

// rad that a drag by so many pixels turns the handle.
double turn_of_drag(const glm::dvec2& lever, const glm::dvec2& drag);

}  // namespace bolt::trainer
