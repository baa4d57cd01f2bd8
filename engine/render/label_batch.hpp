// Labels prepared for the GPU: one quad per glyph, the farthest label first.
#pragma once

#include <optional>
#include <span>

#include "engine/render/label.hpp"
#include "engine/text/atlas.hpp"
#include "shaders/labels.h"

namespace bolt::render {

struct LabelBatch {
    std::vector<shared::LabelFrame> labels;
    std::vector<shared::LabelQuad> quads;
};

// Returns nullopt if the atlas is full. Labels are sorted by depth for `clip_from_world`, the first eye.
std::optional<LabelBatch> make_label_batch(std::span<const Label> labels, const glm::mat4& clip_from_world,
                                           const text::Fonts& fonts, text::Atlas& atlas);

}  // namespace bolt::render
