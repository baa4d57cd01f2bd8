// Projection of the scene to the picture, and picking: the nut or the wrench under the pointer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "engine/render/scene.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainer {

// The projection of the scene to the picture: its eye, and the size of the picture. Positions are in pixels,
// origin at the upper left corner, y down.
struct Projection {
    render::Eye eye;
    glm::dvec2 size{1.0};
};

// None for a point behind the eye.
std::optional<glm::dvec2> project(const Projection& projection, const Vec3& point);

// The nut under the pointer: the nearest one in the picture within its apparent size plus a margin.
std::optional<std::size_t> nut_at(const Projection& projection, const glm::dvec2& pointer,
                                  const servo::Setup& setup, std::span<const Vec3> centres);

// Distance in pixels from the pointer to the segment between two points; none if either is behind the eye.
std::optional<double> pixels_to_segment(const Projection& projection, const glm::dvec2& pointer,
                                        const Vec3& from, const Vec3& to);

inline constexpr double min_lever = 160.0;  // px/rad
// px/rad, motion of the handle's end in the picture while the wrench at `tool` turns clockwise, as seen
// looking along −axis. At least `min_lever` long, because otherwise a handle seen end-on would turn at the
// slightest drag.
glm::dvec2 lever_on_screen(const Projection& projection, const Pose& tool, const Vec3& axis,
                           double handle_length);

// Angle in rad, clockwise positive, by which a drag, in px, turns the handle.
double drag_angle(const glm::dvec2& lever, const glm::dvec2& drag);

}  // namespace bolt::trainer
