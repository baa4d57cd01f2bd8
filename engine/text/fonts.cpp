#include "engine/text/fonts.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace bolt::text {

const std::vector<FontFile>& font_files() {
    static const std::vector<FontFile> files{{"DejaVuSans.ttf", "fonts-dejavu-core"},
                                             {"wqy-microhei.ttc", "fonts-wqy-microhei"}};
    return files;
}

std::vector<std::filesystem::path> font_folders() {
    const char* own = std::getenv("BOLTWRIGHT_FONTS");
    if (own != nullptr && *own != '\0') return {own};
    // The first two are Debian's folders of our fonts; other systems and user fonts follow.
    std::vector<std::filesystem::path> folders{"/usr/share/fonts/truetype/dejavu",
                                               "/usr/share/fonts/truetype/wqy", "/usr/share/fonts",
                                               "/usr/local/share/fonts"};
    if (const char* home = std::getenv("HOME"); home != nullptr)
        folders.push_back(std::filesystem::path(home) / ".local/share/fonts");
    return folders;
}

Result<std::filesystem::path> find_font(const FontFile& font,
                                        const std::vector<std::filesystem::path>& folders) {
    using Walk = std::filesystem::recursive_directory_iterator;
    std::error_code ignored;  // missing and unreadable folders are skipped
    for (const std::filesystem::path& folder : folders)
        for (Walk at(folder, std::filesystem::directory_options::skip_permission_denied, ignored), end;
             at != end; at.increment(ignored))
            if (at->path().filename() == font.file) return at->path();
    return fail(ErrorCode::failed, fmt::format("the font {} is not installed", font.file),
                fmt::format("the package {}, or the folder of the font in BOLTWRIGHT_FONTS", font.package));
}

Result<Fonts> load_fonts() {
    Fonts fonts;
    for (const FontFile& wanted : font_files()) {
        BOLT_TRY_ASSIGN(auto file, find_font(wanted, font_folders()));
        BOLT_TRY_ASSIGN(auto face, Face::read(file));
        fonts.faces.push_back(std::move(face));
    }
    return fonts;
}

GlyphId find_glyph(const Fonts& fonts, char32_t point) {
    for (std::size_t face = 0; face < fonts.faces.size(); ++face)
        if (const int glyph = fonts.faces[face].glyph(point); glyph != 0)
            return {static_cast<int>(face), glyph};
    return {};
}

}  // namespace bolt::text
