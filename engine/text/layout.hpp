// Text layout, and conversion between UTF-8 and code points.
#pragma once

#include <string>
#include <string_view>

#include "engine/text/fonts.hpp"

namespace bolt::text {

// Converts UTF-8 to code points and back. Decoding replaces every byte that does not start a valid character
// by U+FFFD.
std::u32string decode(std::string_view utf8);
std::string encode(std::u32string_view points);

struct PlacedGlyph {
    GlyphId id;
    glm::vec2 at{0.0F};  // em, the glyph's origin on the baseline
};

struct TextLayout {
    std::vector<PlacedGlyph> glyphs;
    glm::vec2 size{0.0F};  // em; the box extends from (0, 0), lower left, to this corner
};

// Lays text out from left to right: one glyph per code point, with kerning, but without the shaping that
// scripts with joined letters (such as Arabic) need. `align` positions lines shorter than the longest: 0
// left, 0.5 centred, 1 right.
TextLayout lay_out(const Fonts& fonts, std::string_view utf8, float align = 0.0F);

}  // namespace bolt::text
