// The fonts that everything is written in: DejaVu Sans for European languages and symbols, and for Chinese
// what DejaVu has not. They are Debian's and are found when the program runs.
#pragma once

#include <string>

#include "engine/text/face.hpp"

namespace bolt::text {

struct FontFile {
    std::string file;     // "DejaVuSans.ttf"
    std::string package;  // that brings it
};

// In the order in which they are asked for a glyph.
const std::vector<FontFile>& font_files();

// Where fonts lie: the folder that BOLTWRIGHT_FONTS names, or the system's.
std::vector<std::filesystem::path> font_folders();

// Looks through the folders and all below them; an error says which package is missing.
Result<std::filesystem::path> find_font(const FontFile& font,
                                        const std::vector<std::filesystem::path>& folders);

struct Fonts {
    std::vector<Face> faces;
};
Result<Fonts> load_fonts();

// The first face that has the code point; a box (glyph 0 of the first) where none has.
struct GlyphId {
    int face = 0, glyph = 0;
    friend auto operator<=>(const GlyphId&, const GlyphId&) = default;
};
GlyphId find(const Fonts& fonts, char32_t point);

}  // namespace bolt::text
