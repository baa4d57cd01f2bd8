// Two eyes: where they are, and their pictures beside each other.
#pragma once

#include <span>
#include <vector>

#include "engine/render/camera.hpp"
#include "engine/render/picture.hpp"

namespace bolt::view {

inline constexpr float eye_distance = 0.063F;  // m, the mean of adults

// m to the right of the middle, of every eye: the left one first, or the one that is there.
std::vector<float> eyes_aside(bool stereo);

// To be put before the clip coordinates of an eye that is `aside`: what is `distance` (m) away along the axis
// is where the other eye sees it too, as on a screen there (the off-axis projection of Kooima, 2008). Without
// it both eyes would stare into the distance, and what is near would have no place in both of their pictures.
glm::mat4 converging(float aside, float distance, const render::Perspective& lens);

// Pictures of the same height as one, the first on the left.
render::Picture side_by_side(std::span<const render::Picture> pictures);

}  // namespace bolt::view
