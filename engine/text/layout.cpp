#include "engine/text/layout.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace bolt::text {

namespace {

constexpr char32_t replacement = 0xFFFD;

// Returns the number of continuation bytes after a first byte; -1: it is invalid.
int continuation_bytes(std::uint8_t first) {
    if (first < 0x80) return 0;
    if (first >= 0xC2 && first < 0xE0) return 1;
    if (first >= 0xE0 && first < 0xF0) return 2;
    if (first >= 0xF0 && first < 0xF5) return 3;
    return -1;
}

// Returns true for overlong encodings, surrogates and values beyond Unicode (RFC 3629).
bool is_invalid(char32_t point, int follow) {
    constexpr std::array<char32_t, 4> smallest{0, 0x80, 0x800, 0x10000};
    return point < smallest.at(static_cast<std::size_t>(follow)) || (point >= 0xD800 && point < 0xE000) ||
           point > 0x10FFFF;
}

}  // namespace

std::u32string decode(std::string_view utf8) {
    std::u32string points;
    for (std::size_t at = 0; at < utf8.size();) {
        const auto first = static_cast<std::uint8_t>(utf8[at]);
        const int follow = continuation_bytes(first);
        char32_t point = follow <= 0 ? first : first & (0x3FU >> follow);
        bool valid = follow >= 0 && at + static_cast<std::size_t>(follow) < utf8.size();
        for (int i = 1; valid && i <= follow; ++i) {
            const auto next = static_cast<std::uint8_t>(utf8[at + static_cast<std::size_t>(i)]);
            valid = (next & 0xC0U) == 0x80U;
            point = point << 6 | (next & 0x3FU);
        }
        valid = valid && !is_invalid(point, follow);
        points.push_back(valid ? point : replacement);
        at += valid ? static_cast<std::size_t>(follow) + 1 : 1;
    }
    return points;
}

std::string encode(std::u32string_view points) {
    std::string utf8;
    for (const char32_t point : points) {
        const int follow = point < 0x80 ? 0 : point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
        constexpr std::array<std::uint32_t, 4> marks{0x00, 0xC0, 0xE0, 0xF0};
        for (int i = follow; i >= 0; --i) {
            const auto bits = static_cast<std::uint32_t>(point) >> (6 * i);
            const std::uint32_t byte =
                i == follow ? marks.at(static_cast<std::size_t>(follow)) | bits : 0x80U | (bits & 0x3FU);
            utf8.push_back(static_cast<char>(byte));
        }
    }
    return utf8;
}

namespace {

struct TextLine {
    std::size_t first = 0;  // index of its first glyph
    float width = 0.0F;
};

}  // namespace

TextLayout lay_out(const Fonts& fonts, std::string_view utf8, float align) {
    TextLayout layout;
    std::vector<TextLine> lines(1);
    GlyphId before;
    for (const char32_t point : decode(utf8)) {
        if (point == U'\n') {
            lines.push_back({layout.glyphs.size(), 0.0F});
            before = {};
            continue;
        }
        const GlyphId id = find_glyph(fonts, point);
        const FontFace& face = fonts.faces[static_cast<std::size_t>(id.face)];
        float& x = lines.back().width;
        if (before.glyph != 0 && before.face == id.face) x += face.kerning(before.glyph, id.glyph);
        layout.glyphs.push_back({id, {x, 0.0F}});
        x += face.advance(id.glyph);
        before = id;
    }
    const float ascent = fonts.faces.front().ascent(), descent = fonts.faces.front().descent();
    const float height = ascent + descent;
    for (const TextLine& line : lines) layout.size.x = std::max(layout.size.x, line.width);
    layout.size.y = height * static_cast<float>(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::size_t end = i + 1 < lines.size() ? lines[i + 1].first : layout.glyphs.size();
        const glm::vec2 move(align * (layout.size.x - lines[i].width),
                             descent + height * static_cast<float>(lines.size() - 1 - i));
        for (std::size_t g = lines[i].first; g < end; ++g) layout.glyphs[g].at += move;
    }
    return layout;
}

}  // namespace bolt::text
