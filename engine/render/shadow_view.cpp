#include "engine/render/shadow_view.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/render/camera.hpp"

namespace bolt::render {

glm::mat4 shadow_view(const Box& box, const glm::vec3& direction) {
    const glm::mat4 turn = look_at(glm::vec3(0.0F), glm::normalize(direction));
    const Box seen = transformed(box, turn);  // looks along −Z
    const glm::vec3 size = glm::max(seen.high - seen.low, glm::vec3(1e-6F));
    const glm::vec3 margin(0.01F);
    glm::mat4 fit(1.0F);
    fit[0][0] = 2.0F / (size.x * (1.0F + 2.0F * margin.x));
    fit[1][1] = -2.0F / (size.y * (1.0F + 2.0F * margin.y));
    fit[2][2] = -1.0F / (size.z * (1.0F + 2.0F * margin.z));
    const glm::vec3 middle = 0.5F * (seen.low + seen.high);
    fit[3] = glm::vec4(-fit[0][0] * middle.x, -fit[1][1] * middle.y, 0.5F - fit[2][2] * middle.z, 1.0F);
    return fit * turn;
}

}  // namespace bolt::render
