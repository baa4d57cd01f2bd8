// Where the shadow map of a directional light looks.
#pragma once

#include "engine/render/scene.hpp"

namespace bolt::render {

// An orthographic view along `direction` that holds the whole box: depth 0 nearest the light, 1 farthest.
glm::mat4 shadow_view(const Box& box, const glm::vec3& direction);

}  // namespace bolt::render
