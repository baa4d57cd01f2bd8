// The materials of the workshop, with textures generated from noise.
#pragma once

#include <array>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

enum WorkshopMaterial : int {
    concrete,
    line_paint,
    wall_upper,
    wall_lower,
    beech,
    frame_paint,
    drawer_paint,
    ground_steel,
    zinc,
    board_steel,
    tool_chrome,
    tool_black,
    tool_grip,
    lamp_housing,
    lamp_glow,
    workshop_materials
};

// Texture repeats per metre, by material.
extern const std::array<double, workshop_materials> workshop_repeats;

Status add_workshop_materials(assets::Model& model);

}  // namespace bolt::sculpt
