#include "engine/text/fonts.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "engine/text/layout.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::text;

TEST_CASE("Fonts: every character of German, Chinese and bolting symbols has a glyph") {
    const Result<Fonts> fonts = load_fonts();
    REQUIRE(fonts.has_value());
    REQUIRE(fonts->faces.size() == 2);
    for (const char32_t point : std::u32string_view(U"AZaz09ÄÖÜäöüßẞéñ·×°±²³≈≤≥√µμσ∠→"))
        CHECK(fonts->faces[0].glyph(point) != 0);
    for (const char32_t point : std::u32string_view(U"螺栓预紧力拧扳手减速器扭矩角度顺序第一步，。（）"))
        CHECK(find_glyph(*fonts, point).glyph != 0);
    CHECK(find_glyph(*fonts, U'扭').face == 1);
    CHECK(find_glyph(*fonts, U'ß').face == 0);
    CHECK(find_glyph(*fonts, 0x10FFFF) == GlyphId{});  // no font has this character: the box glyph
    CHECK(fonts->faces[0].advance(0) > 0.0F);
}

TEST_CASE("Fonts: the error for a missing font names its package") {
    const test::Folder kept;
    const std::filesystem::path& folder = kept.path();
    std::filesystem::create_directories(folder / "deep");
    const FontFile wanted{"Nobody.ttf", "fonts-nobody"};
    for (const auto& where : {folder, folder / "nowhere"}) {
        const auto found = find_font(wanted, {where});
        REQUIRE_FALSE(found.has_value());
        CHECK(found.error().what.find("Nobody.ttf") != std::string::npos);
        CHECK(found.error().expected.find("fonts-nobody") != std::string::npos);
    }
    std::ofstream(folder / "deep" / "Nobody.ttf") << "no font at all";
    const auto found = find_font(wanted, {folder / "nowhere", folder});
    REQUIRE(found.has_value());
    const Result<FontFace> face = FontFace::read(*found);
    REQUIRE_FALSE(face.has_value());
    CHECK(face.error().file == found->string());
    std::filesystem::remove_all(folder);
}

TEST_CASE("Text layout: line widths, line spacing and alignment follow the font") {
    const Result<Fonts> fonts = load_fonts();
    REQUIRE(fonts.has_value());
    const FontFace& face = fonts->faces[0];
    const float line = face.ascent() + face.descent();
    CHECK(line == doctest::Approx(1.164).epsilon(0.01));  // DejaVu Sans: 1901 and 483 of 2048 units
    const TextLayout one = lay_out(*fonts, "nn");
    REQUIRE(one.glyphs.size() == 2);
    CHECK(one.size.x == doctest::Approx(static_cast<double>(2.0F * face.advance(face.glyph('n')))));
    CHECK(one.size.y == doctest::Approx(static_cast<double>(line)));
    CHECK(one.glyphs[0].at == glm::vec2(0.0F, face.descent()));
    CHECK(lay_out(*fonts, "AV").size.x <
          face.advance(face.glyph('A')) + face.advance(face.glyph('V')));  // with kerning
    for (const float align : {0.0F, 0.5F, 1.0F}) {
        const TextLayout two = lay_out(*fonts, "n\nnnn", align);
        REQUIRE(two.glyphs.size() == 4);
        CHECK(two.size.y == doctest::Approx(static_cast<double>(2.0F * line)));
        CHECK(two.glyphs[0].at.y == doctest::Approx(static_cast<double>(face.descent() + line)));
        CHECK(two.glyphs[1].at == glm::vec2(0.0F, face.descent()));
        CHECK(two.glyphs[0].at.x ==
              doctest::Approx(static_cast<double>(align * 2.0F * face.advance(face.glyph('n')))));
    }
    CHECK(lay_out(*fonts, "").glyphs.empty());
    CHECK(lay_out(*fonts, "预紧").size.x == doctest::Approx(2.0).epsilon(0.05));  // one em each
}
