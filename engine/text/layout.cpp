#include "engine/text/layout.hpp"

#include <algorithm>

#include "engine/text/utf8.hpp"

namespace bolt::text {

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
        const Face& face = fonts.faces[static_cast<std::size_t>(id.face)];
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
