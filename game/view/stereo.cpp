#include "game/view/stereo.hpp"

#include <cmath>

namespace bolt::view {

std::vector<float> eyes_aside(bool stereo) {
    if (!stereo) return {0.0F};
    return {-0.5F * eye_distance, 0.5F * eye_distance};
}

glm::mat4 converging(float aside, float distance, const render::Perspective& lens) {
    glm::mat4 shear(1.0F);
    shear[3][0] = aside / (distance * std::tan(0.5F * lens.fov) * lens.aspect);  // x + this · w
    return shear;
}

render::Picture side_by_side(std::span<const render::Picture> pictures) {
    render::Picture all{0, pictures.front().height, {}};
    for (const render::Picture& picture : pictures) all.width += picture.width;
    for (std::size_t y = 0; y < all.height; ++y)
        for (const render::Picture& picture : pictures) {
            const std::size_t row = std::size_t{4} * picture.width;
            const auto begin = picture.rgba.begin() + static_cast<std::ptrdiff_t>(row * y);
            all.rgba.insert(all.rgba.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
        }
    return all;
}

}  // namespace bolt::view
