// Projections with depth 1 at the near plane and 0 at the far one (more even precision; N. Reed, Depth
// Precision Visualized, 2015), y down in clip space as Vulkan wants it.
#pragma once

#include "engine/render/scene.hpp"

namespace bolt::render {

struct Perspective {
    float fov = 0.6F;                    // vertical, rad
    float aspect = 1.0F;                 // width over height
    float znear = 0.05F, zfar = 100.0F;  // m
};

glm::mat4 perspective(const Perspective& p);

// Looking from `eye` to `target`, with Y up as far as that goes.
glm::mat4 look_at(const glm::vec3& eye, const glm::vec3& target);

Eye make_eye(const glm::vec3& eye, const glm::vec3& target, const Perspective& p);

// A wall, screen or panel seen from `eye`: the projection through a rectangle in the world, given by three of
// its corners (R. Kooima, Generalized Perspective Projection, 2008). Walls that share an edge meet without a
// seam.
Eye make_wall_eye(const glm::vec3& eye, const glm::vec3& lower_left, const glm::vec3& lower_right,
                  const glm::vec3& upper_left, float znear, float zfar);

// From where the whole box is seen from direction `side` (towards the viewer), filling the picture.
glm::vec3 framing_eye(const Box& box, const glm::vec3& side, const Perspective& p);

// Whether a box may be in sight; never says no of one that is.
bool in_sight(const Box& box, const glm::mat4& clip_from_world);

}  // namespace bolt::render
