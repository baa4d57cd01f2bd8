// Where plates and panels lie over the picture: what stands in the scene keeps out of there.
#pragma once

#include <vector>

#include "engine/render/overlay.hpp"

namespace bolt::trainer {

// Those of the interface as it is being drawn, px; between ui::Ui::begin and end, after the last of them.
std::vector<render::Rectangle> occupied_areas();

}  // namespace bolt::trainer
