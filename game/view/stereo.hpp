// Two eyes: where they are, and their pictures beside each other.
#pragma once

#include <span>
#include <vector>

#include "engine/render/picture.hpp"

namespace bolt::view {

inline constexpr float eye_distance = 0.063F;  // m, the mean of adults

// m to the right of the middle, of every eye: the left one first, or the one that is there.
std::vector<float> eyes_aside(bool stereo);

// Pictures of the same height as one, the first on the left.
render::Picture side_by_side(std::span<const render::Picture> pictures);

}  // namespace bolt::view
