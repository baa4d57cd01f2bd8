// Text layout from left to right: one glyph per code point, with kerning, without shaping for joining
// scripts.
#pragma once

#include <string_view>

#include "engine/text/fonts.hpp"

namespace bolt::text {

struct PlacedGlyph {
    GlyphId id;
    glm::vec2 at{0.0F};  // em, the glyph's origin on the baseline
};

struct TextLayout {
    std::vector<PlacedGlyph> glyphs;
    glm::vec2 size{0.0F};  // em; the box extends from (0, 0), lower left, to this corner
};

// `align` positions lines shorter than the longest: 0 left, 0.5 centred, 1 right.
TextLayout lay_out(const Fonts& fonts, std::string_view utf8, float align = 0.0F);

}  // namespace bolt::text
