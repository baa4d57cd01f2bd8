// A font file: which glyphs it has, how wide they are and what they look like. Lengths are shares of an em.
// The file is trusted: stb_truetype does not guard itself against hostile ones, so only fonts of the system
// are read.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::text {

// Closed rings of points; what they wind around is filled (non-zero rule).
using Outline = std::vector<std::vector<glm::dvec2>>;

class Face {
  public:
    // TrueType or OpenType; of a collection the first face.
    static Result<Face> read(const std::filesystem::path& file);

    Face(Face&&) noexcept;
    Face& operator=(Face&&) noexcept;
    ~Face();

    [[nodiscard]] int glyph(char32_t point) const;  // 0: it has none
    [[nodiscard]] float advance(int glyph) const;
    [[nodiscard]] float kerning(int left, int right) const;
    [[nodiscard]] float ascent() const;   // of a line above its baseline
    [[nodiscard]] float descent() const;  // below it, positive

    // Curves become lines that stay within `tolerance` of them.
    [[nodiscard]] Outline outline(int glyph, double tolerance) const;

    // Coverage of each pixel at this size with the origin `shift` (pixels, 0 … 1) to the right of a pixel's
    // edge: what a rasteriser makes of it. Rows from the top; the upper left corner is `left`, `top` pixels
    // from the origin (y up).
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
