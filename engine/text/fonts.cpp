#include "engine/text/fonts.hpp"

#include <fmt/format.h>
#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "engine/base/file.hpp"

namespace bolt::text {

namespace {

constexpr std::size_t max_font_size = std::size_t{128} << 20;  // bytes

// A point on a quadratic Bézier curve.
glm::dvec2 quadratic(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, double t) {
    return glm::mix(glm::mix(a, b, t), glm::mix(b, c, t), t);
}

// Returns the number of segments that keep a flattened curve within the tolerance: the error of a chord over
// 1/n of the curve is |second derivative| / 8n².
int segment_count(double second_derivative, double tolerance) {
    return std::clamp(static_cast<int>(std::ceil(std::sqrt(second_derivative / (8.0 * tolerance)))), 1, 64);
}

}  // namespace

struct FontFace::Data {
    std::string bytes;
    stbtt_fontinfo info{};
    float em_per_unit = 1.0F;  // size of a font unit
    float ascent = 0.0F, descent = 0.0F;
};

FontFace::FontFace(std::unique_ptr<Data> data) : data_(std::move(data)) {}
FontFace::FontFace(FontFace&&) noexcept = default;
FontFace& FontFace::operator=(FontFace&&) noexcept = default;
FontFace::~FontFace() = default;

Result<FontFace> FontFace::read(const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(auto bytes, read_file(file, max_font_size, ErrorCode::failed));
    auto data = std::make_unique<Data>();
    data->bytes = std::move(bytes);
    // stb_truetype would read past the end of a file shorter than a table directory.
    const auto* first = reinterpret_cast<const unsigned char*>(data->bytes.data());
    const int offset = data->bytes.size() < 64 ? -1 : stbtt_GetFontOffsetForIndex(first, 0);
    if (offset < 0 || stbtt_InitFont(&data->info, first, offset) == 0) {
        Error error;
        error.code = ErrorCode::failed;
        error.what = "is not a readable font";
        error.expected = "a TrueType or OpenType font";
        error.file = file.string();
        return fail(std::move(error));
    }
    data->em_per_unit = stbtt_ScaleForMappingEmToPixels(&data->info, 1.0F);
    int ascent = 0, descent = 0, gap = 0;
    stbtt_GetFontVMetrics(&data->info, &ascent, &descent, &gap);
    data->ascent = data->em_per_unit * static_cast<float>(ascent);
    data->descent = -data->em_per_unit * static_cast<float>(descent);
    return FontFace(std::move(data));
}

int FontFace::glyph(char32_t point) const {
    return stbtt_FindGlyphIndex(&data_->info, static_cast<int>(point));
}

float FontFace::advance(int glyph) const {
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&data_->info, glyph, &advance, &bearing);
    return data_->em_per_unit * static_cast<float>(advance);
}

float FontFace::kerning(int left, int right) const {
    return data_->em_per_unit * static_cast<float>(stbtt_GetGlyphKernAdvance(&data_->info, left, right));
}

float FontFace::ascent() const { return data_->ascent; }
float FontFace::descent() const { return data_->descent; }

GlyphOutline FontFace::outline(int glyph, double tolerance) const {
    stbtt_vertex* vertices = nullptr;
    const int count = stbtt_GetGlyphShape(&data_->info, glyph, &vertices);
    GlyphOutline outline;
    const auto em = static_cast<double>(data_->em_per_unit);
    glm::dvec2 at(0.0);
    for (int i = 0; i < count; ++i) {
        const stbtt_vertex& v = vertices[i];
        const glm::dvec2 to = em * glm::dvec2(v.x, v.y), c1 = em * glm::dvec2(v.cx, v.cy),
                         c2 = em * glm::dvec2(v.cx1, v.cy1);
        if (v.type == STBTT_vmove) {
            outline.push_back({to});
        } else if (v.type == STBTT_vline) {
            outline.back().push_back(to);
        } else if (v.type == STBTT_vcurve) {
            const int n = segment_count(2.0 * glm::length(at - 2.0 * c1 + to), tolerance);
            for (int k = 1; k <= n; ++k)
                outline.back().push_back(quadratic(at, c1, to, static_cast<double>(k) / n));
        } else {
            const double second_derivative =
                6.0 * std::max(glm::length(at - 2.0 * c1 + c2), glm::length(c1 - 2.0 * c2 + to));
            const int n = segment_count(second_derivative, tolerance);
            for (int k = 1; k <= n; ++k) {
                const double t = static_cast<double>(k) / n;
                outline.back().push_back(glm::mix(quadratic(at, c1, c2, t), quadratic(c1, c2, to, t), t));
            }
        }
        at = to;
    }
    stbtt_FreeShape(&data_->info, vertices);
    return outline;
}

FontFace::Raster FontFace::raster(int glyph, float em_px, float shift) const {
    const float scale = em_px * data_->em_per_unit;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&data_->info, glyph, scale, scale, shift, 0.0F, &x0, &y0, &x1, &y1);
    Raster raster{x1 - x0, y1 - y0, x0, -y0, {}};
    raster.coverage.resize(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
    if (!raster.coverage.empty())
        stbtt_MakeGlyphBitmapSubpixel(&data_->info, raster.coverage.data(), raster.width, raster.height,
                                      raster.width, scale, scale, shift, 0.0F, glyph);
    return raster;
}

const std::vector<FontFile>& font_files() {
    static const std::vector<FontFile> files{{"DejaVuSans.ttf", "fonts-dejavu-core"},
                                             {"wqy-microhei.ttc", "fonts-wqy-microhei"}};
    return files;
}

std::vector<std::filesystem::path> font_folders() {
    const char* folder = std::getenv("BOLTWRIGHT_FONTS");
    if (folder != nullptr && *folder != '\0') return {folder};
    // The first two are Debian's folders of our fonts; then come those of other systems and the user's.
    std::vector<std::filesystem::path> folders{"/usr/share/fonts/truetype/dejavu",
                                               "/usr/share/fonts/truetype/wqy", "/usr/share/fonts",
                                               "/usr/local/share/fonts"};
    if (const char* home = std::getenv("HOME"); home != nullptr)
        folders.push_back(std::filesystem::path(home) / ".local/share/fonts");
    return folders;
}

Result<std::filesystem::path> find_font(const FontFile& font,
                                        const std::vector<std::filesystem::path>& folders) {
    using Iterator = std::filesystem::recursive_directory_iterator;
    std::error_code ignored;  // missing and unreadable folders are skipped
    for (const std::filesystem::path& folder : folders)
        for (Iterator at(folder, std::filesystem::directory_options::skip_permission_denied, ignored), end;
             at != end; at.increment(ignored))
            if (at->path().filename() == font.file) return at->path();
    return fail(ErrorCode::failed, fmt::format("the font {} is not installed", font.file),
                fmt::format("the package {}, or the folder with the font in BOLTWRIGHT_FONTS", font.package));
}

Result<Fonts> load_fonts() {
    Fonts fonts;
    for (const FontFile& font : font_files()) {
        BOLT_TRY_ASSIGN(auto file, find_font(font, font_folders()));
        BOLT_TRY_ASSIGN(auto face, FontFace::read(file));
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
