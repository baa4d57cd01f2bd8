#include "tools/verify/pathtrace/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::pathtrace {

namespace {

struct Axes {
    glm::vec3 right, up, forward;
};

Axes axes(const glm::vec3& forward) {
    const glm::vec3 f = glm::normalize(forward);
    // Straight down or up there is no way up; −Z takes its place.
    const glm::vec3 up = std::abs(f.y) < 0.9999F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(f, up));
    return {right, glm::cross(right, f), f};
}

}  // namespace

glm::vec3 direction(const Camera& camera, const glm::vec2& pixel) {
    const Axes a = axes(camera.target - camera.eye);
    const float half = std::tan(0.5F * camera.fov);
    const float scale = 2.0F * half / static_cast<float>(camera.height);
    const float x = (pixel.x - 0.5F * static_cast<float>(camera.width)) * scale;
    const float y = (0.5F * static_cast<float>(camera.height) - pixel.y) * scale;
    return glm::normalize(a.forward + x * a.right + y * a.up);
}

Camera frame(const Camera& camera, const glm::vec3& low, const glm::vec3& high, const glm::vec3& view) {
    const Axes a = axes(-view);
    const glm::vec3 middle = 0.5F * (low + high);
    const float margin = 1.06F;
    const float tan_y = std::tan(0.5F * camera.fov) / margin;
    const float tan_x = tan_y * static_cast<float>(camera.width) / static_cast<float>(camera.height);
    float distance = 0.0F;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p = glm::vec3((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                      (corner & 4) != 0 ? high.z : low.z) -
                            middle;
        const float depth = glm::dot(p, a.forward);
        distance = std::max({distance, std::abs(glm::dot(p, a.right)) / tan_x - depth,
                             std::abs(glm::dot(p, a.up)) / tan_y - depth});
    }
    Camera framed = camera;
    framed.target = middle;
    framed.eye = middle - a.forward * std::max(distance, 1e-3F);
    return framed;
}

}  // namespace bolt::pathtrace
