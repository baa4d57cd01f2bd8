// A font file: its glyphs, metrics and outlines, in units of an em. The file must be trusted: stb_truetype
// does not validate its input, so only system fonts are read.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::text {

// Closed polygons, filled by the non-zero winding rule.
using Outline = std::vector<std::vector<glm::dvec2>>;

class Face {
  public:
    // Reads TrueType or OpenType; the first face of a collection.
    static Result<Face> read(const std::filesystem::path& file);

    Face(Face&&) noexcept;
    Face& operator=(Face&&) noexcept;
    ~Face();

    [[nodiscard]] int glyph(char32_t point) const;  // 0: the face has no such glyph
    [[nodiscard]] float advance(int glyph) const;
    [[nodiscard]] float kerning(int left, int right) const;
    [[nodiscard]] float ascent() const;   // above the baseline
    [[nodiscard]] float descent() const;  // below the baseline, positive

    // Returns the outline with curves flattened within `tolerance`.
    [[nodiscard]] Outline outline(int glyph, double tolerance) const;

    // The pixel coverage of a glyph from stb_truetype's rasteriser, with the origin `shift` (0 … 1 pixel) to
    // the right of a pixel edge. Rows from the top; the upper left corner is at (`left`, `top`) pixels from
    // the origin, y up.
    struct Raster {
        int width = 0, height = 0, left = 0, top = 0;
        std::vector<unsigned char> coverage;
    };
    [[nodiscard]] Raster raster(int glyph, float em_px, float shift = 0.0F) const;

  private:
    struct Data;
    explicit Face(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

}  // namespace bolt::text
