// Projections with reversed depth: 1 at the near plane, 0 at the far plane (more even precision; N. Reed,
// Depth Precision Visualized, 2015). Clip space has y down, as in Vulkan.
#pragma once

#include "engine/render/scene.hpp"

namespace bolt::render {

struct Perspective {
    float fov = 0.6F;                    // vertical, rad
    float aspect = 1.0F;                 // width / height
    float znear = 0.05F, zfar = 100.0F;  // m
};

glm::mat4 perspective(const Perspective& p);

// Returns the view from `eye` towards `target`, with Y up unless the view is vertical.
glm::mat4 look_at(const glm::vec3& eye, const glm::vec3& target);

Eye make_eye(const glm::vec3& eye, const glm::vec3& target, const Perspective& p);

// The off-axis view from `eye` through a wall, screen or panel: the projection through a rectangle in the
// world, given by three of its corners (R. Kooima, Generalized Perspective Projection, 2008). Pictures on
// walls that share an edge meet without a seam.
Eye make_wall_eye(const glm::vec3& eye, const glm::vec3& lower_left, const glm::vec3& inset_rectangle,
                  const glm::vec3& upper_left, float znear, float zfar);

// Returns the eye position from which the box fills the picture. `side` points from the box towards the eye.
glm::vec3 framing_eye(const BoundingBox& box, const glm::vec3& side, const Perspective& p);

// Returns whether a box may be visible; conservative: never false for a visible box.
bool in_sight(const BoundingBox& box, const glm::mat4& clip_from_world);

// The view of a directional light's shadow map: an orthographic view along `direction` that contains the box,
// with depth 0 nearest the light and 1 farthest.
glm::mat4 shadow_view(const BoundingBox& box, const glm::vec3& direction);

}  // namespace bolt::render
