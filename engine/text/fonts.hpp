// A font file: its glyphs, metrics and outlines, in units of an em. The file must be trusted: stb_truetype
// does not validate its input, so only system fonts are read.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
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

// The fonts of all texts: DejaVu Sans for European languages and symbols, and a second font for Chinese. They
// are Debian packages and are searched for at run time.

struct FontFile {
    std::string file;     // "DejaVuSans.ttf"
    std::string package;  // the package that contains it
};

// In order of priority.
const std::vector<FontFile>& font_files();

// The folders with fonts: the one in BOLTWRIGHT_FONTS, or the system's.
std::vector<std::filesystem::path> font_folders();

// Searches the folders recursively. The error names the missing package.
Result<std::filesystem::path> find_font(const FontFile& font,
                                        const std::vector<std::filesystem::path>& folders);

struct Fonts {
    std::vector<Face> faces;
};
Result<Fonts> load_fonts();

// The glyph of the first face that has the code point; otherwise a box (glyph 0 of the first face).
struct GlyphId {
    int face = 0, glyph = 0;
    friend auto operator<=>(const GlyphId&, const GlyphId&) = default;
};
GlyphId find_glyph(const Fonts& fonts, char32_t point);

}  // namespace bolt::text
