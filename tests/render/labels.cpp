// Labels: agreement with a rasteriser, sharpness at every distance, and occlusion by parts in front.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/text/layout.hpp"
#include "tests/render/support.hpp"

namespace render_labels_test {

using namespace bolt;
using namespace bolt::render;

namespace {

// The origin is at the corner between the four centre pixels.
Eye front(VkExtent2D extent, float distance = 2.0F) {
    Perspective p;
    p.aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    p.zfar = 2.0F * distance;
    return make_eye({0, 0, distance}, {0, 0, 0}, p);
}

Scene black() {
    Scene scene;
    scene.background = {0, 0, 0, 1};
    return scene;
}

double linear_value(int encoded) {
    const double x = encoded / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// The white coverage of each pixel.
std::vector<double> coverage(const Picture& picture) {
    std::vector<double> values;
    for (std::size_t i = 1; i < picture.rgba.size(); i += 4) values.push_back(linear_value(picture.rgba[i]));
    return values;
}

// The text rasterised by stb_truetype, with its first baseline starting at the centre of the picture.
std::vector<double> rasterised(const text::Fonts& fonts, const std::string& utf8, float em_px,
                               VkExtent2D extent) {
    std::vector<double> values(std::size_t{extent.width} * extent.height);
    for (const text::PlacedGlyph& placed : text::lay_out(fonts, utf8).glyphs) {
        const text::FontFace& face = fonts.faces[static_cast<std::size_t>(placed.id.face)];
        const float x = placed.at.x * em_px;
        const text::FontFace::Raster raster = face.raster(placed.id.glyph, em_px, x - std::floor(x));
        for (int row = 0; row < raster.height; ++row)
            for (int column = 0; column < raster.width; ++column) {
                const int px = static_cast<int>(extent.width / 2) + static_cast<int>(std::floor(x)) +
                               raster.left + column,
                          py = static_cast<int>(extent.height / 2) - raster.top + row;
                REQUIRE(px >= 0);
                REQUIRE(px < static_cast<int>(extent.width));
                double& value =
                    values[static_cast<std::size_t>(py) * extent.width + static_cast<std::size_t>(px)];
                value += raster.coverage[static_cast<std::size_t>(row * raster.width + column)] / 255.0;
                value = std::min(value, 1.0);
            }
    }
    return values;
}

// Returns the fraction of the reference's ink that is elsewhere in `made`.
double astray(const std::vector<double>& made, const std::vector<double>& reference) {
    REQUIRE(made.size() == reference.size());
    double ink = 0.0, off = 0.0;
    for (std::size_t i = 0; i < made.size(); ++i) {
        ink += reference[i];
        off += std::abs(made[i] - reference[i]);
    }
    REQUIRE(ink > 10.0);
    return off / ink;
}

// The left and right edge of a full block, U+2588, in em.
constexpr const char* block = "\u2588";
glm::dvec2 block_edges(const text::Fonts& fonts) {
    glm::dvec2 edges(1.0, 0.0);
    for (const auto& ring : fonts.faces[0].outline(fonts.faces[0].glyph(U'\u2588'), 0.001))
        for (const glm::dvec2& point : ring) edges = {std::min(edges.x, point.x), std::max(edges.y, point.x)};
    REQUIRE(edges.y - edges.x > 0.5);
    return edges;
}

Label written(const text::Fonts& fonts, const std::string& utf8, float em_px) {
    Label label;
    label.text = utf8;
    label.height = em_px;
    label.anchor = {0, 0};
    // The label's position is on the baseline, not at the lower edge of the line.
    label.offset_px.y = -em_px * fonts.faces[0].descent();
    return label;
}

}  // namespace

TEST_CASE("Labels: text agrees with stb_truetype at the same size") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    test::Studio studio;
    constexpr VkExtent2D extent{512, 128};
    struct Case {
        std::string text;
        float em_px;
        double bound;
    };
    for (const Case& c :
         {Case{"M8: 25 N·m ≈ Größe", 14.0F, 0.16}, Case{"M8: 25 N·m ≈ Größe", 22.5F, 0.08},
          Case{"Qy7ß", 60.0F, 0.035}, Case{"预紧力矩", 20.0F, 0.07}, Case{"预紧力", 48.0F, 0.045}}) {
        CAPTURE(c.text);
        CAPTURE(c.em_px);
        Scene scene = black();
        scene.labels.push_back(written(*fonts, c.text, c.em_px));
        const std::vector<double> made = coverage(studio.shoot(scene, front(extent), extent));
        const std::vector<double> reference = rasterised(*fonts, c.text, c.em_px, extent);
        const double off = astray(made, reference);
        CAPTURE(off);
        CHECK(off < c.bound);
        // Negative control: a shift by three quarters of a pixel or slightly bolder text is detected.
        scene.labels[0].offset_px.x = 0.75F;
        CHECK(astray(coverage(studio.shoot(scene, front(extent), extent)), reference) > 1.5 * c.bound);
        scene.labels[0].offset_px.x = 0.0F;
        scene.labels[0].outline = glm::vec4(1.0F);
        scene.labels[0].outline_width = 0.6F / c.em_px;
        CHECK(astray(coverage(studio.shoot(scene, front(extent), extent)), reference) > 1.5 * c.bound);
    }
}

namespace {

// Returns the width of an edge from 10 % to 90 % in pixels. The edge is moved over a pixel in steps of 1/32,
// which samples the profile far finer than the pixels.
double rise(test::Studio& studio, Scene scene, const Eye& eye, VkExtent2D extent, int blur) {
    constexpr int steps = 32;
    std::vector<double> profile(static_cast<std::size_t>(steps) * 12);
    for (int step = 0; step < steps; ++step) {
        scene.labels[0].offset_px.x = -static_cast<float>(step) / steps;
        const std::vector<double> row = coverage(studio.shoot(scene, eye, extent));
        const std::size_t middle = std::size_t{extent.height / 2} * extent.width + extent.width / 2 - 6;
        for (std::size_t i = 0; i < 12; ++i) {
            double sum = 0.0;
            for (int b = -blur; b <= blur; ++b) sum += row[middle + i + static_cast<std::size_t>(b + 8) - 8];
            profile[i * steps + static_cast<std::size_t>(step)] = sum / (2 * blur + 1);
        }
    }
    const auto first_above = [&](double level) {
        for (std::size_t i = 0; i < profile.size(); ++i)
            if (profile[i] >= level) return static_cast<double>(i);
        return -1.0;
    };
    REQUIRE(profile.front() < 0.02);
    REQUIRE(profile.back() > 0.98);
    return (first_above(0.9) - first_above(0.1)) / steps;
}

}  // namespace

TEST_CASE("Labels: glyph edges are one pixel wide, near and far, frontal and oblique") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    test::Studio studio;
    constexpr VkExtent2D extent{96, 64};
    const auto turned = [](float about_y, float about_z) {
        return glm::angleAxis(about_y, glm::vec3(0, 1, 0)) * glm::angleAxis(about_z, glm::vec3(0, 0, 1));
    };
    for (const float distance : {0.5F, 2.0F, 6.0F})
        for (const glm::quat& turn : {turned(0, 0), turned(1.2F, 0), turned(0, 0.3F), turned(-1.0F, 0.4F)}) {
            CAPTURE(distance);
            CAPTURE(turn.y);
            CAPTURE(turn.z);
            Scene scene = black();
            Label label;
            label.text = block;
            label.placement = LabelPlacement::fixed;
            label.orientation = turn;
            label.height = 3.0F;
            // Places the block's left edge at the centre of the picture.
            label.anchor = {static_cast<float>(block_edges(*fonts).x) / text::lay_out(*fonts, block).size.x,
                            0.5F};
            scene.labels.push_back(label);
            const Eye eye = front(extent, distance);
            const double made = rise(studio, scene, eye, extent, 0);
            CAPTURE(made);
            // A box filter gives 0.8 for an upright edge and up to a tenth more for an oblique one.
            CHECK(made > 0.5);
            CHECK(made < 1.5);
            CHECK(rise(studio, scene, eye, extent, 1) > 1.5);  // a blurred edge is detected
        }
}

TEST_CASE(
    "Labels: a label is fixed in its plane, faces the eye with scene size, or is constant on the screen") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    const double width = block_edges(*fonts).y - block_edges(*fonts).x;  // em
    test::Studio studio;
    constexpr VkExtent2D extent{160, 120};
    // Returns the visible width and height in pixels.
    const auto seen = [&](const Label& label, const Eye& eye) {
        Scene scene = black();
        scene.labels.push_back(label);
        const std::vector<double> values = coverage(studio.shoot(scene, eye, extent));
        glm::dvec2 sum(0.0);  // of the middle row and column
        for (std::size_t x = 0; x < extent.width; ++x) sum.x += values[std::size_t{60} * extent.width + x];
        for (std::size_t y = 0; y < extent.height; ++y) sum.y += values[y * extent.width + 80];
        return sum;
    };
    Label label;
    label.text = block;  // higher than a line
    label.height = 0.2F;
    const double metre = 60.0 / std::tan(0.3) / 2.0;  // px at a distance of 2
    label.placement = LabelPlacement::facing;
    const glm::dvec2 facing = seen(label, front(extent));
    CHECK(facing.x == doctest::Approx(0.2 * width * metre).epsilon(0.02));
    CHECK(facing.y > facing.x * 1.4);
    const glm::dvec2 twice = seen(label, front(extent, 4.0F));
    CHECK(twice.x == doctest::Approx(0.5 * facing.x).epsilon(0.01));
    CHECK(twice.y == doctest::Approx(0.5 * facing.y).epsilon(0.01));
    Perspective p;
    p.aspect = 4.0F / 3.0F;
    const glm::dvec2 aside = seen(label, make_eye({2.0F * std::sin(1.0F), 0, 2.0F * std::cos(1.0F)}, {}, p));
    CHECK(aside.x == doctest::Approx(facing.x).epsilon(0.01));

    label.placement = LabelPlacement::fixed;
    CHECK(seen(label, front(extent)).x == doctest::Approx(facing.x).epsilon(0.01));
    label.orientation = glm::angleAxis(1.0471976F, glm::vec3(0, 1, 0));
    CHECK(seen(label, front(extent)).x == doctest::Approx(0.5 * facing.x).epsilon(0.03));
    label.orientation = glm::angleAxis(1.5707963F, glm::vec3(0, 0, 1));
    CHECK(seen(label, front(extent)).y == doctest::Approx(facing.x).epsilon(0.02));

    label.placement = LabelPlacement::on_screen;
    label.height = 40.0F;
    for (const float distance : {0.5F, 2.0F, 9.0F})
        CHECK(seen(label, front(extent, distance)).x == doctest::Approx(40.0 * width).epsilon(0.01));
    label.anchor.x = 0.0F;  // everything to the right of the centre
    label.offset_px.x = 10.0F;
    CHECK(seen(label, front(extent)).x == doctest::Approx(40.0 * width).epsilon(0.01));
    CHECK(seen(label, front(extent)).y == doctest::Approx(0.0));
    CHECK(seen(label, make_eye({0, 0, 2}, {0, 0, 4}, p)).x == 0.0);  // behind the eye
}

TEST_CASE("Labels: parts in front hide a label, up to its visible fraction") {
    test::Studio studio;
    assets::Material flat;
    flat.base_color = {0, 0, 0, 1};
    const assets::Model model = test::plate(flat);
    const GpuModel gpu_model = studio.upload(model);
    constexpr VkExtent2D extent{96, 64};
    const Eye eye = front(extent);
    // A black plate, upright at z = 0, covers the right half of the picture; the label is in front of it or
    // behind it.
    const auto whiteness = [&](float z, float through, float before = 0.0F) {
        Scene scene = black();
        add_model(scene, model, gpu_model,
                  glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, 1, 0), glm::vec4(0, -1, 0, 0),
                            glm::vec4(1, 0, 0, 1)));
        Label label;
        label.text = std::string(block) + block;
        label.position.z = z;
        label.height = 24.0F;
        label.occluded_visibility = through;
        label.occlusion_margin = before;
        scene.labels.push_back(label);
        const std::vector<double> values = coverage(studio.shoot(scene, eye, extent));
        const std::size_t row = std::size_t{32} * extent.width;
        return std::pair{values[row + 40], values[row + 56]};
    };
    CHECK(whiteness(0.1F, 0.0F) == std::pair{1.0, 1.0});
    CHECK(whiteness(-0.1F, 0.0F).first == 1.0);
    CHECK(whiteness(-0.1F, 0.0F).second < 0.001);
    CHECK(whiteness(-0.1F, 0.25F).second == doctest::Approx(0.25).epsilon(0.03));
    CHECK(whiteness(-0.1F, 1.0F).second == 1.0);
    CHECK(whiteness(-0.1F, 0.0F, 0.11F).second == 1.0);
    CHECK(whiteness(-0.1F, 0.0F, 0.09F).second < 0.001);
}

TEST_CASE("Labels: outline and background are behind the text, and the background has the right size") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    test::Studio studio;
    constexpr VkExtent2D extent{160, 96};
    Scene scene = black();
    Label label;
    label.text = "H";
    label.height = 40.0F;
    label.color = {1, 0, 0, 1};
    label.outline = {0, 0, 1, 1};
    label.outline_width = 0.1F;
    label.plate = {0, 1, 0, 1};
    scene.labels.push_back(label);
    const Picture made = studio.shoot(scene, front(extent), extent);
    double green = 0.0, red = 0.0, blue = 0.0;
    for (std::size_t i = 0; i < made.rgba.size(); i += 4) {
        red += linear_value(made.rgba[i]);
        green += linear_value(made.rgba[i + 1]);
        blue += linear_value(made.rgba[i + 2]);
    }
    // Half an em wider, 0.15 em higher and lower; corner radius 0.3 em.
    const glm::vec2 text = text::lay_out(*fonts, "H").size, plate = text + 2.0F * glm::vec2(0.35F, 0.15F);
    const double area = 1600.0 * (static_cast<double>(plate.x * plate.y) - (4.0 - 3.14159265) * 0.09);
    CHECK(red + green + blue == doctest::Approx(area).epsilon(0.005));
    label.outline = label.plate = glm::vec4(0.0F);
    scene.labels[0] = label;
    const Picture bare = studio.shoot(scene, front(extent), extent);
    double red_alone = 0.0;
    for (std::size_t i = 0; i < bare.rgba.size(); i += 4) red_alone += linear_value(bare.rgba[i]);
    CHECK(red == doctest::Approx(red_alone).epsilon(0.005));  // the outline does not cover the glyph
    CHECK(blue > 0.6 * red);
}

TEST_CASE("Labels: the nearer of two labels covers the other, in any order of the scene") {
    test::Studio studio;
    constexpr VkExtent2D extent{64, 48};
    const auto middle = [&](float first, float second) {
        Scene scene = black();
        for (const auto& [z, color] :
             {std::pair{first, glm::vec4(1, 0, 0, 1)}, {second, glm::vec4(0, 1, 0, 1)}}) {
            Label label;
            label.text = block;
            label.position.z = z;
            label.color = color;
            scene.labels.push_back(label);
        }
        return test::pixel(studio.shoot(scene, front(extent), extent), 32, 24);
    };
    CHECK(middle(0.5F, 0.0F) == glm::ivec4(255, 0, 0, 255));
    CHECK(middle(0.0F, 0.5F) == glm::ivec4(0, 255, 0, 255));
    CHECK(middle(0.0F, 0.0F) == glm::ivec4(0, 255, 0, 255));  // at equal distance the later label is in front
}

TEST_CASE("Labels: each of several views equals its single picture, and a full atlas restarts") {
    for (const auto multiview : {RendererOptions::Multiview::never, RendererOptions::Multiview::always}) {
        RendererOptions options;
        options.multiview = multiview;
        test::Studio studio(options), alone;
        Scene scene = black();
        Label label;
        label.text = "B7 预紧 25 N·m";
        label.height = 12.0F;
        label.plate = {0.1F, 0.2F, 0.3F, 0.8F};
        scene.labels.push_back(label);
        label.placement = LabelPlacement::facing;
        label.position = {0, 0.25F, 0.5F};  // not clipped: see multiview.cpp
        label.height = 0.06F;
        scene.labels.push_back(label);
        const VkExtent2D extent{128, 96};
        const Eye eyes[] = {make_eye({-0.2F, 0, 2}, {0, 0, 0}, {}), make_eye({0.2F, 0, 2}, {0, 0, 0}, {})};
        const std::vector<Picture> both = studio.shoot(scene, eyes, extent);
        for (std::size_t i = 0; i < 2; ++i)
            CHECK(test::largest_difference(both[i], alone.shoot(scene, eyes[i], extent)) <= 1);
        CHECK(test::largest_difference(both[0], both[1]) > 50);

        // Chinese characters that need a larger atlas, then others that restart it, and then the first labels
        // again.
        const auto all = [](char32_t first, char32_t count) {
            std::u32string points;
            for (char32_t i = 0; i < count; ++i) points += first + i;
            Scene full = black();
            full.labels.resize(1);
            full.labels[0].text = text::encode(points);
            return full;
        };
        if (multiview == RendererOptions::Multiview::never)
            for (const auto& [first, count] : {std::pair{0x4E00U, 200U}, {0x5300U, 560U}})
                (void)studio.shoot(all(first, count), eyes[0], extent);
        CHECK(test::largest_difference(studio.shoot(scene, eyes[0], extent), both[0]) <= 1);
    }
}

}  // namespace render_labels_test
