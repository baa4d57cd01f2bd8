#include "engine/text/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/text/distance_field.hpp"

namespace bolt::text {

namespace {

// Tolerance for flattened curves, well below the size of a texel.
constexpr double tolerance = 0.02 / Atlas::texels_per_em;

}  // namespace

// Fill the background with the largest distance: small text samples slightly beyond its glyphs.
Atlas::Atlas(int size)
    : size_(size),
      texels_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
              glm::packHalf1x16(static_cast<float>(-reach))),
      changed_high_(size) {}

const AtlasGlyph* Atlas::glyph(const Fonts& fonts, const GlyphId& id) {
    if (const auto known = glyphs_.find(id); known != glyphs_.end()) return &known->second;
    const Face& face = fonts.faces.at(static_cast<std::size_t>(id.face));
    const DistanceField field = distance_field(face.outline(id.glyph, tolerance), texels_per_em, reach);
    if (field.width == 0) return &glyphs_.emplace(id, AtlasGlyph{}).first->second;
    if (next_ + field.width > size_) {
        shelf_ += shelf_height_;
        shelf_height_ = next_ = 0;
    }
    if (field.width > size_ || shelf_ + field.height > size_) return nullptr;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x)
            texels_[static_cast<std::size_t>((shelf_ + y) * size_ + next_ + x)] =
                glm::packHalf1x16(field.distances[static_cast<std::size_t>(y * field.width + x)]);
    // Neighbouring fields touch, so keep the sampled area half a texel inside.
    const auto uv = [&](double x, double y) { return glm::vec2((next_ + x) / size_, (shelf_ + y) / size_); };
    const auto em = [&](double x, double y) {
        return glm::vec2(field.low + glm::dvec2(x, y) / texels_per_em);
    };
    const AtlasGlyph glyph{em(0.5, 0.5), em(field.width - 0.5, field.height - 0.5), uv(0.5, 0.5),
                           uv(field.width - 0.5, field.height - 0.5)};
    changed_low_ = changed_high_ == 0 ? shelf_ : std::min(changed_low_, shelf_);
    changed_high_ = std::max(changed_high_, shelf_ + field.height);
    next_ += field.width;
    shelf_height_ = std::max(shelf_height_, field.height);
    return &glyphs_.emplace(id, glyph).first->second;
}

Atlas::Rows Atlas::take_changed() {
    const Rows rows{changed_low_, changed_high_ - changed_low_};
    changed_low_ = changed_high_ = 0;
    return rows;
}

}  // namespace bolt::text
