// Views and projections. Depth is reversed: 1 at the near plane, 0 at the far plane, which makes the
// precision more even (N. Reed, Depth Precision Visualized, 2015). Clip space has y down, as in Vulkan.
#pragma once

#include "engine/base/math.hpp"
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

// Returns the view of an eye of a headset, which looks along −Z of its pose with Y up.
Eye make_eye(const Pose& pose, const FieldOfView& fov, float znear, float zfar);

// Returns the same view in another frame. `pose`: the pose of that frame in the frame of `eye`.
Eye seen_from(const Eye& eye, const Pose& pose);

// Returns the off-axis view from `eye` through a wall, screen or panel: the projection through a rectangle in
// the world, given by three of its corners (R. Kooima, Generalized Perspective Projection, 2008). Pictures on
// walls that share an edge join without a seam.
Eye make_wall_eye(const glm::vec3& eye, const glm::vec3& lower_left, const glm::vec3& lower_right,
                  const glm::vec3& upper_left, float znear, float zfar);

// Returns the eye position from which the box fills the picture. `side` points from the box towards the eye.
glm::vec3 framing_eye(const BoundingBox& box, const glm::vec3& side, const Perspective& p);

// Returns false if the box is certainly outside the view; may return true for an invisible box.
// `margin`: how far beyond the edges of the picture counts as visible, in half widths and heights.
bool may_be_visible(const BoundingBox& box, const glm::mat4& clip_from_world, float margin = 0.0F);

// Returns the view of a directional light's shadow map: an orthographic view along `direction` that contains
// the box. Its depth is not reversed: 0 nearest the light, 1 farthest.
glm::mat4 shadow_view(const BoundingBox& box, const glm::vec3& direction);

}  // namespace bolt::render
