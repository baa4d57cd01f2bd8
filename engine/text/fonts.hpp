// The fonts of all texts: DejaVu Sans for European languages and symbols, and a second font for Chinese. They
// are Debian packages and are searched for at run time.
#pragma once

#include <string>

#include "engine/text/face.hpp"

namespace bolt::text {

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
