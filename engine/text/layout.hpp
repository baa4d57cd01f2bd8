// Text set in lines: which glyph stands where. Left to right, a glyph a code point, with kerning; no shaping
// of scripts that join their letters.
#pragma once

#include <string_view>

#include "engine/text/fonts.hpp"

namespace bolt::text {

struct PlacedGlyph {
    GlyphId id;
    glm::vec2 at{0.0F};  // em, its origin on the baseline
};

struct Layout {
    std::vector<PlacedGlyph> glyphs;
    glm::vec2 size{0.0F};  // em; the box goes from (0, 0), lower left, to it
};

// `align` moves lines that are shorter than the longest: 0 left, 0.5 to the middle, 1 right.
Layout lay_out(const Fonts& fonts, std::string_view utf8, float align = 0.0F);

}  // namespace bolt::text
