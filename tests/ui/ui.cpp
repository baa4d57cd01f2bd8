// Tests of the user interface by its pictures and its input.
#include "engine/ui/ui.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/text/layout.hpp"
#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr VkExtent2D extent{480, 160};

// An offscreen window that shows the interface over a black scene.
struct Screen {
    test::Studio studio;
    std::unique_ptr<ui::Ui> ui = studio.gpu().need(ui::Ui::create(studio.gpu().device()));
    ui::UiInput input;
    Scene scene;

    Screen() {
        input.size = {extent.width, extent.height};
        input.seconds = 1.0 / 60.0;
        scene.background = {0, 0, 0, 1};
    }

    // Draws one frame of an interface.
    template <class Draw>
    Picture show(ui::Ui& of, const Draw& draw) {
        gpu::FrameContext* frame = studio.gpu().need(studio.frames().begin());
        const Eye eye = make_eye({0, 0, 5}, {0, 0, 0}, {});
        studio.gpu().need(studio.renderer().render(*frame, scene, {&eye, 1}, extent));
        studio.gpu().need(of.begin(*frame, input));
        draw(*frame);
        studio.gpu().need(studio.renderer().draw_over(*frame, of.end(), studio.renderer().picture(0)));
        studio.gpu().need(studio.frames().submit(*frame));
        return studio.download(studio.renderer().picture(0));
    }
    template <class Draw>
    Picture show(const Draw& draw) {
        return show(*ui, [&](gpu::FrameContext&) { draw(); });
    }

    Picture written(const std::string& text) {
        return show(
            [&] { ImGui::GetForegroundDrawList()->AddText(ImVec2(40, 40), IM_COL32_WHITE, text.c_str()); });
    }
};

double linear_value(int encoded) {
    const double x = encoded / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

std::vector<double> coverage(const Picture& picture) {
    std::vector<double> values;
    for (std::size_t i = 1; i < picture.rgba.size(); i += 4) values.push_back(linear_value(picture.rgba[i]));
    return values;
}

// Returns the fraction of a text's ink (rasterised by stb_truetype at this size) that is elsewhere in the
// picture, for the best origin near (40, 40) and one line below.
double astray(const std::vector<double>& made, const text::Fonts& fonts, const std::string& utf8,
              float em_px) {
    const text::TextLayout layout = text::lay_out(fonts, utf8);
    double best = 1e9;
    const int baseline = 40 + static_cast<int>(std::lround(em_px * fonts.faces[0].ascent()));
    for (int dy = -2; dy <= 2; ++dy) {
        std::vector<double> values(made.size());
        double ink = 0.0;
        for (const text::PlacedGlyph& placed : layout.glyphs) {
            const text::FontFace& face = fonts.faces[static_cast<std::size_t>(placed.id.face)];
            const float x = placed.at.x * em_px;
            const text::FontFace::Raster raster = face.raster(placed.id.glyph, em_px, x - std::floor(x));
            for (int row = 0; row < raster.height; ++row)
                for (int column = 0; column < raster.width; ++column) {
                    const int px = 40 + static_cast<int>(std::floor(x)) + raster.left + column,
                              py = baseline + dy - raster.top + row;
                    const double value =
                        raster.coverage[static_cast<std::size_t>(row * raster.width + column)];
                    values[static_cast<std::size_t>(py) * extent.width + static_cast<std::size_t>(px)] +=
                        value / 255.0;
                    ink += value / 255.0;
                }
        }
        REQUIRE(ink > 10.0);
        double off = 0.0;
        for (std::size_t i = 0; i < made.size(); ++i) off += std::abs(made[i] - std::min(values[i], 1.0));
        best = std::min(best, off / ink);
    }
    return best;
}

// ImGui's sizes, from the lowest to the highest point, are whole pixels.
float displayed_em(const text::FontFace& face, float em_px) {
    const float line = face.ascent() + face.descent();
    return std::round(em_px * line) / line;
}

}  // namespace

TEST_CASE("Text: rasterised at its displayed size on displays of every scale") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    Screen screen;
    const std::string word = "HEFT";  // upright stems: ImGui places glyphs at other fractions of a pixel
    for (const float scale : {1.0F, 1.25F, 1.5F, 2.0F, 2.5F}) {
        CAPTURE(scale);
        screen.input.scale = scale;
        const float em = displayed_em(fonts->faces[0], 14.0F * scale);
        const double off = astray(coverage(screen.written(word)), *fonts, word, em);
        CAPTURE(off);
        CHECK(off < 0.1);
    }
    // Negative control: text that is rasterised at half the size and scaled up differs.
    screen.input.scale = 1.0F;
    const std::vector<double> small = coverage(screen.written(word));
    std::vector<double> stretched(small.size());
    for (std::size_t y = 0; y < extent.height; ++y)
        for (std::size_t x = 0; x < extent.width; ++x)
            if (x >= 40 && y >= 40 && (x - 40) / 2 + 40 < extent.width)
                stretched[y * extent.width + x] =
                    small[((y - 40) / 2 + 40) * extent.width + (x - 40) / 2 + 40];
    CHECK(astray(stretched, *fonts, word, 28.0F) > 0.2);
}

TEST_CASE("Text: Chinese characters are available after add_characters()") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    Screen screen;
    screen.input.scale = 2.0F;
    const std::string word = "预紧力";
    const Picture unknown = screen.written(word);
    screen.ui->add_characters(word);
    const Picture known = screen.written(word);
    CHECK(test::largest_difference(unknown, known) > 100);
    const auto chinese = static_cast<std::size_t>(text::lay_out(*fonts, word).glyphs[0].id.face);
    const float em = displayed_em(fonts->faces[chinese], 28.0F);
    CHECK(astray(coverage(known), *fonts, word, em) < 0.1);
    CHECK(astray(coverage(unknown), *fonts, word, em) > 0.5);
    CHECK(screen.written(word).rgba == known.rgba);
    CHECK(screen.written("Größe").rgba != screen.written("Gr??e").rgba);  // German is always available
}

TEST_CASE("ImGui: fills and clips are exact to the pixel") {
    Screen screen;
    const Picture made = screen.show([] {
        ImDrawList& list = *ImGui::GetForegroundDrawList();
        list.PushClipRect(ImVec2(100, 20), ImVec2(140, 60));
        list.AddRectFilled(ImVec2(90, 30), ImVec2(120, 70), IM_COL32(10, 200, 90, 255));
        list.PopClipRect();
    });
    int wrong = 0;
    for (std::uint32_t y = 0; y < made.height; ++y)
        for (std::uint32_t x = 0; x < made.width; ++x) {
            const bool inside = x >= 100 && x < 120 && y >= 30 && y < 60;
            wrong +=
                test::pixel(made, x, y) == (inside ? glm::ivec4(10, 200, 90, 255) : glm::ivec4(0, 0, 0, 255))
                    ? 0
                    : 1;
        }
    CHECK(wrong == 0);
}

TEST_CASE("Pictures: another view is drawn with one texel per pixel") {
    Screen screen;
    screen.scene.background = {0, 0, 0, 1};
    const assets::Model model = test::sphere({}, 24);
    const GpuModel gpu_model = screen.studio.upload(model);
    add_model(screen.scene, model, gpu_model);
    const EnvironmentLight light = screen.studio.light(shading::studio_environment(64));
    screen.scene.environment = &light;
    const Eye eye = make_eye({2, 1, 3}, {0, 0, 0}, {});
    const Picture single = screen.studio.shoot(screen.scene, eye, {60, 60});
    const Picture made = screen.show(*screen.ui, [&](gpu::FrameContext& frame) {
        Renderer& renderer = screen.studio.renderer();
        screen.studio.gpu().need(renderer.render(frame, screen.scene, {&eye, 1}, {60, 60}, 3));
        const ImTextureID id = screen.ui->picture(renderer.picture(0, 3));
        ImGui::GetForegroundDrawList()->AddImage(id, ImVec2(300, 50), ImVec2(360, 110));
    });
    int largest = 0;
    for (std::uint32_t y = 0; y < 60; ++y)
        for (std::uint32_t x = 0; x < 60; ++x) {
            const glm::ivec4 d = glm::abs(test::pixel(made, 300 + x, 50 + y) - test::pixel(single, x, y));
            largest = std::max({largest, d.x, d.y, d.z});
        }
    CHECK(largest <= 1);
    CHECK(test::pixel(single, 30, 30) != test::pixel(single, 2, 2));
}

TEST_CASE("Input: a click between two frames counts, and text can be typed in every language") {
    Screen screen;
    int clicks = 0;
    bool over = false;
    char typed[64] = "";
    const auto panel = [&] {
        ImGui::SetNextWindowPos(ImVec2(20, 20));
        ImGui::SetNextWindowSize(ImVec2(200, 120));
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
        if (ImGui::Button("Go", ImVec2(100, 30))) ++clicks;
        ImGui::InputText("name", typed, sizeof typed);
        ImGui::End();
        over = screen.ui->wants_pointer();
    };
    screen.input.pointer_inside = true;
    screen.input.pointer = {60, 40};
    (void)screen.show(panel);
    (void)screen.show(panel);
    CHECK(over);
    screen.input.buttons[0].down = true;
    (void)screen.show(panel);
    screen.input.buttons[0].down = false;
    (void)screen.show(panel);
    CHECK(clicks == 1);
    screen.input.buttons[0].pressed = true;  // down and up since the last frame
    (void)screen.show(panel);
    screen.input.buttons[0].pressed = false;
    (void)screen.show(panel);
    CHECK(clicks == 2);
    screen.input.pointer = {60, 84};  // the field below
    screen.input.buttons[0].pressed = true;
    (void)screen.show(panel);
    screen.input.buttons[0].pressed = false;
    (void)screen.show(panel);
    CHECK(screen.ui->wants_keys());
    screen.input.text = "Größe 预x";
    (void)screen.show(panel);
    screen.input.text.clear();
    screen.input.key(ui::UiKey::backspace).down = true;
    (void)screen.show(panel);
    screen.input.key(ui::UiKey::backspace).down = false;
    (void)screen.show(panel);
    CHECK(std::string(typed) == "Größe 预");
    screen.input.pointer = {400, 140};
    (void)screen.show(panel);
    (void)screen.show(panel);
    CHECK_FALSE(over);
    screen.input.pointer_inside = false;
    (void)screen.show(panel);
    CHECK_FALSE(over);
    CHECK(clicks == 2);
}

TEST_CASE("Ui: two interfaces are independent") {
    Screen screen;
    ui::UiOptions large;
    large.text_size = 30.0F;
    const auto other = screen.studio.gpu().need(ui::Ui::create(screen.studio.gpu().device(), large));
    const auto window = [](gpu::FrameContext&) {
        ImGui::SetNextWindowPos(ImVec2(10, 10));
        ImGui::Begin("window", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::TextUnformatted("M8 × 30");
        ImGui::End();
    };
    (void)screen.show(*screen.ui, window);
    const Picture first = screen.show(*screen.ui, window);
    (void)screen.show(*other, window);
    const Picture second = screen.show(*other, window);
    CHECK(test::largest_difference(first, second) > 50);
    CHECK(screen.show(*screen.ui, window).rgba == first.rgba);
    CHECK(screen.show(*other, window).rgba == second.rgba);
}
