// The camera: position, directions and angle of view.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace bolt::pathtrace {

struct Camera {
    glm::vec3 eye{0.0F, 0.0F, 1.0F};
    glm::vec3 target{0.0F};
    float fov = 0.6108652F;  // vertical, rad
    int width = 800, height = 600;
};

// The ray through a point of the picture in pixels from its top left corner; of unit length.
glm::vec3 direction(const Camera& camera, const glm::vec2& pixel);

// A camera that sees the box `low`–`high` from `view` (towards the viewer), filling the picture.
Camera frame(const Camera& camera, const glm::vec3& low, const glm::vec3& high, const glm::vec3& view);

}  // namespace bolt::pathtrace
