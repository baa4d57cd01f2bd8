// Font files, and the fonts that all texts use: DejaVu Sans for European languages and symbols, and a second
// font for Chinese. Both are Debian packages and are searched for at run time.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::text {

// Closed polygons, filled by the non-zero winding rule.
using GlyphOutline = std::vector<std::vector<glm::dvec2>>;

// The glyphs, metrics and outlines of a font, in units of an em. The file must be trusted, because
// stb_truetype does not validate its input: read only system fonts.
class FontFace {
  public:
    // Reads a TrueType or OpenType file, or the first face of a collection.
    static Result<FontFace> read(const std::filesystem::path& file);

    FontFace(FontFace&&) noexcept;
    FontFace& operator=(FontFace&&) noexcept;
    ~FontFace();

    [[nodiscard]] int glyph(char32_t point) const;  // 0: the face has no such glyph
    [[nodiscard]] float advance(int glyph) const;
    [[nodiscard]] float kerning(int left, int right) const;
    [[nodiscard]] float ascent() const;   // above the baseline
    [[nodiscard]] float descent() const;  // below the baseline, positive

    // Returns the outline with curves flattened within `tolerance`.
    [[nodiscard]] GlyphOutline outline(int glyph, double tolerance) const;

    // The pixel coverage of a glyph. Rows from the top; the upper left corner is at (`left`, `top`) pixels
    // from the glyph's origin, y up.
    struct Raster {
        int width = 0, height = 0, left = 0, top = 0;
        std::vector<unsigned char> coverage;  // 0 … 255
    };
    // Rasterises a glyph with stb_truetype, its origin `shift` (0 … 1 pixel) to the right of a pixel edge.
    [[nodiscard]] Raster raster(int glyph, float em_px, float shift = 0.0F) const;

  private:
    struct Data;
    explicit FontFace(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

struct FontFile {
    std::string file;     // "DejaVuSans.ttf"
    std::string package;  // the package that contains it
};

// Returns the fonts in which all text is drawn, in order of priority.
const std::vector<FontFile>& font_files();

// Returns the folders with fonts: the one in the environment variable BOLTWRIGHT_FONTS, or those of the
// system and of the user.
std::vector<std::filesystem::path> font_folders();

// Searches the folders recursively. The error names the package that contains the font.
Result<std::filesystem::path> find_font(const FontFile& font,
                                        const std::vector<std::filesystem::path>& folders);

struct Fonts {
    std::vector<FontFace> faces;
};
Result<Fonts> load_fonts();

struct GlyphId {
    int face = 0, glyph = 0;  // index into Fonts::faces, and the glyph's number in that face
    friend auto operator<=>(const GlyphId&, const GlyphId&) = default;
};
// Returns the glyph of the first face that has the code point; otherwise a box (glyph 0 of the first face).
GlyphId find_glyph(const Fonts& fonts, char32_t point);

}  // namespace bolt::text
