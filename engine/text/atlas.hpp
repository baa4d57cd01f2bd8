// The distance fields of the glyphs that are in use, packed into one square of half floats. It fills as text
// asks for glyphs; who draws it uploads the rows that have changed.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "engine/text/fonts.hpp"

namespace bolt::text {

struct AtlasGlyph {
    glm::vec2 low{0.0F}, high{0.0F};        // em, about the glyph's origin; equal: nothing to be seen
    glm::vec2 uv_low{0.0F}, uv_high{0.0F};  // 0 … 1; v goes up with y
};

class Atlas {
  public:
    static constexpr double texels_per_em = 64.0;
    static constexpr double reach = 0.125;  // em: how far from the edge the distance is known

    explicit Atlas(int size);

    // Makes it if it is new. Null: there is no room left.
    const AtlasGlyph* glyph(const Fonts& fonts, const GlyphId& id);

    [[nodiscard]] int size() const { return size_; }
    [[nodiscard]] std::span<const std::uint16_t> texels() const { return texels_; }

    // Rows that have changed since the last call; at first all of them.
    struct Rows {
        int first = 0, count = 0;
    };
    Rows take_changed();

  private:
    int size_;
    std::vector<std::uint16_t> texels_;
    std::map<GlyphId, AtlasGlyph> glyphs_;
    int shelf_ = 0, shelf_height_ = 0, next_ = 0;  // where the next glyph goes
    int changed_low_ = 0, changed_high_;
};

}  // namespace bolt::text
