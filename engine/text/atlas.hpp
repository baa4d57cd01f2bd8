// Signed distance fields of glyphs (C. Green, Improved Alpha-Tested Magnification for Vector Textures, 2007),
// for sharp edges at every size and angle, and an atlas of them. Distances are computed from the outline
// itself, not from a raster.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "engine/text/fonts.hpp"

namespace bolt::text {

struct DistanceField {
    int width = 0, height = 0;
    glm::dvec2 low{0.0};           // em, lower left corner of the first texel
    std::vector<float> distances;  // em, positive inside, rows from the bottom; clamped to [-reach, reach]
};

// The field extends `reach` (em) beyond the outline on every side. Returns an empty field for an outline
// without edges.
DistanceField distance_field(const GlyphOutline& outline, double texels_per_em, double reach);

// The place of a glyph's distance field in the texture.
struct AtlasGlyph {
    glm::vec2 low{0.0F}, high{0.0F};        // em from the glyph's origin; equal if there is nothing to draw
    glm::vec2 uv_low{0.0F}, uv_high{0.0F};  // 0 … 1; v increases with y
};

// Glyph distance fields in one square texture of half floats. Glyphs are added on demand; the owner of the
// GPU texture uploads the rows that have changed.
class Atlas {
  public:
    static constexpr double texels_per_em = 64.0;
    static constexpr double reach = 0.125;  // em: range of the stored distances

    explicit Atlas(int size);

    // Returns a glyph and adds it if it is new. Returns null if the atlas is full.
    const AtlasGlyph* glyph(const Fonts& fonts, const GlyphId& id);

    [[nodiscard]] int size() const { return size_; }
    [[nodiscard]] std::span<const std::uint16_t> texels() const { return texels_; }

    struct RowRange {
        int first = 0, count = 0;
    };
    // Returns the rows that have changed since the last call. The first call returns all rows.
    RowRange take_changed_rows();

  private:
    int size_;
    std::vector<std::uint16_t> texels_;
    std::map<GlyphId, AtlasGlyph> glyphs_;
    // Shelf packing: the current shelf's first row and height, and the column of the next glyph.
    int shelf_ = 0, shelf_height_ = 0, next_ = 0;
    int changed_low_ = 0, changed_high_;
};

}  // namespace bolt::text
