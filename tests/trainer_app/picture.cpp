// Close-up, hints and labels in the picture of a lesson, and the backdrop of the menu.
#include <algorithm>
#include <thread>

#include "game/view/labels.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

constexpr test::Display big_letters{{320, 180}, 0.5F};

AppOptions options(lesson::Mode mode, bool menu, const char* folder) {
    AppOptions o = test::options("cover-m8", menu);
    o.choice.mode = mode;
    o.choice.task = lesson::Task::loosen;
    o.choice.language = "en";
    o.out = std::filesystem::path(BOLT_TRAINER_OUT) / folder;
    return o;
}

// Takes the wrench.
void take_wrench(test::HeadlessTrainer& driver) {
    driver.frame();
    driver.key(platform::Key::t);
    for (int i = 0; i < 40 && !hand_of(driver.lesson()).wrench; ++i) driver.frame({}, 0.25);
    REQUIRE(hand_of(driver.lesson()).wrench);
}

// Fraction of the pixels of `in` that differ between two pictures.
double share_changed(const render::Picture& a, const render::Picture& b, const render::Rectangle& in) {
    for (const render::Picture* picture : {&a, &b}) {
        REQUIRE(in.high.x <= static_cast<float>(picture->width));
        REQUIRE(in.high.y <= static_cast<float>(picture->height));
    }
    int changed = 0, all = 0;
    for (auto y = static_cast<std::size_t>(in.low.y); y < static_cast<std::size_t>(in.high.y); ++y)
        for (auto x = static_cast<std::size_t>(in.low.x); x < static_cast<std::size_t>(in.high.x); ++x) {
            const std::size_t at = 4 * (y * a.width + x);
            ++all;
            changed += std::equal(&a.rgba[at], &a.rgba[at] + 3, &b.rgba[at]) ? 0 : 1;
        }
    return static_cast<double>(changed) / all;
}

bool straight_arrow_shown(const ActiveLesson& p) {
    bool shown = false;
    const_cast<scene::SceneWorld&>(p.workplace.world)
        .view<const scene::ArrowMarker>()
        .each([&](const scene::ArrowMarker& it) {
            shown = shown || (it.shown && it.shape == scene::ArrowShape::straight);
        });
    return shown;
}

}  // namespace

TEST_CASE("Resolution: a scene with fewer pixels fills the window, under an interface that has all of them") {
    test::HeadlessTrainer driver(options(lesson::Mode::guided, false, "resolution"), big_letters);
    driver.frame();
    driver.frame();
    const auto take = [&](float resolution) {
        driver.resolution = resolution;
        driver.frame({}, 0.0);
        return driver.picture();
    };
    const auto mean_difference = [](const render::Picture& a, const render::Picture& b) {
        REQUIRE(a.rgba.size() == b.rgba.size());
        double sum = 0.0;
        for (std::size_t at = 0; at < a.rgba.size(); ++at) sum += std::abs(int{a.rgba[at]} - int{b.rgba[at]});
        return sum / static_cast<double>(a.rgba.size());
    };
    const render::Picture full = take(1.0F), half = take(0.5F), again = take(1.0F);
    CHECK(full.rgba == again.rgba);
    CHECK(half.rgba != full.rgba);
    CHECK(mean_difference(half, full) < 6.0);  // the same scene at the same place
    // The window of the pause screen is opaque but for its rim: its texts are the same.
    driver.resolution = 1.0F;
    driver.key(platform::Key::escape);
    REQUIRE(driver.lesson().clock.paused);
    const render::Picture sharp = take(1.0F), paused = take(0.5F);
    const auto widgets = driver.app().drawn_widgets();
    REQUIRE(!widgets.empty());
    for (const DrawnWidget& widget : widgets) {
        const glm::vec2 middle(widget.middle);
        CHECK(share_changed(sharp, paused, {middle - 4.0F, middle + 4.0F}) == 0.0);
    }
    // Control: in front of the scene they differ.
    CHECK(share_changed(sharp, paused, {{0.0F, 0.0F}, {320.0F, 180.0F}}) > 0.1);
    take(0.5F);
    driver.lose_gpu();
    (void)take(0.5F);  // the interface measures its windows in its first frame
    CHECK(mean_difference(take(0.5F), paused) < 1.0);
}

TEST_CASE("Close-up: shown with the wrench at a nut, from above; hidden by its key and without the wrench") {
    test::HeadlessTrainer driver(options(lesson::Mode::guided, false, "seen-guided"), big_letters);
    take_wrench(driver);
    CHECK_FALSE(driver.lesson().view.close_up.joint);  // far from any nut
    driver.key(platform::Key::h);
    driver.key(platform::Key::h);
    driver.frame();
    CHECK(straight_arrow_shown(driver.lesson()));
    const std::size_t joint = driver.lesson().session->lesson().due()->joint;
    driver.key(platform::Key::v);
    for (int i = 0; i < 4; ++i) driver.frame({}, 0.25);
    const glm::dvec2 at = driver.hold(joint);
    const CloseUp& c = driver.lesson().view.close_up;
    REQUIRE(c.joint == joint);
    CHECK(c.visibility >= 0.6);
    const servo::NutGeometry& nut = driver.lesson().session->setup().nuts[joint];
    CHECK(glm::dot(c.tool * c.eye - c.tool.position, nut.axis) > 0.03);
    driver.draw_interval = 1;  // the panels get their sizes when they are drawn
    driver.wait(0.6);
    driver.frame({}, 0.001);
    const render::Picture with = driver.picture();
    const auto place =
        close_up_rectangle(glm::dvec2(big_letters.size.width, big_letters.size.height), 0.5F, {});
    REQUIRE(place);
    driver.frame({platform::KeyEvent{platform::Key::i, true, false, {}}}, 0.001);
    CHECK_FALSE(c.joint);
    const render::Picture without = driver.picture();
    CHECK(share_changed(with, without, *place) > 0.5);
    CHECK(share_changed(with, without, {{170.0F, 70.0F}, {320.0F, 120.0F}}) < 0.05);
    driver.key(platform::Key::i);
    CHECK(c.joint == joint);
    driver.release(at);
    driver.wait(1.0);
    driver.key(platform::Key::t);
    for (int i = 0; i < 12; ++i) driver.frame({}, 0.25);
    CHECK_FALSE(c.joint);
}

TEST_CASE("Assessment: no close-up and no arrow, whatever key is pressed") {
    test::HeadlessTrainer driver(options(lesson::Mode::assessment, false, "seen-assessment"), big_letters);
    take_wrench(driver);
    driver.key(platform::Key::i);
    driver.key(platform::Key::h);
    driver.hold(0);
    driver.frame();
    CHECK_FALSE(driver.lesson().view.close_up.joint);
    CHECK_FALSE(straight_arrow_shown(driver.lesson()));
}

TEST_CASE("Hint panel: it has its full size from its first frame on") {
    test::HeadlessTrainer driver(options(lesson::Mode::guided, false, "seen-hint"), big_letters);
    driver.frame();
    const auto hint_plate = [&]() -> std::optional<render::Rectangle> {
        for (const render::Rectangle& plate : driver.lesson().view.occupied)
            if (plate.low.y < 10.0F && plate.high.x > 0.6F * 320.0F) return plate;
        return std::nullopt;
    };
    const words::LoadedWords en = words::load_words(words::words_folder(), "en");
    int changed = 0;
    std::string said;
    std::optional<render::Rectangle> first;
    for (int i = 0; i < 120 && changed < 3; ++i) {
        if (i == 60) driver.key(platform::Key::h);
        driver.frame();
        const auto& hint = driver.lesson().guidance.hints.shown;
        const std::string now = hint ? lesson::hint_text(en.words, *hint) + std::to_string(hint->level) : "";
        if (now == said && first) {
            REQUIRE(hint_plate());
            CHECK(first->low == hint_plate()->low);
            CHECK(first->high == hint_plate()->high);
            ++changed;
        }
        first = now != said && !now.empty() ? hint_plate() : std::nullopt;
        said = now;
    }
    CHECK(changed == 3);
}

TEST_CASE("Hint: at its third level the ghost moves, at its second it rests") {
    test::HeadlessTrainer driver(options(lesson::Mode::guided, false, "seen-ghost"));
    driver.draws = false;
    // The poses of the shown ghosts in ten frames, while the hint has this level.
    const auto ghosts = [&](int level) {
        for (int i = 0; i < 600; ++i) {
            driver.frame();
            const auto& hint = driver.lesson().guidance.hints.shown;
            if (hint && hint->level == level && hint->ghost() != lesson::GhostKind::none) break;
        }
        std::vector<glm::mat4> poses;
        for (int i = 0; i < 10; ++i) {
            driver.frame();
            // view() is not const.
            auto& world = const_cast<scene::SceneWorld&>(driver.lesson().workplace.world);
            world.view<const scene::GhostPart, const scene::Transform>().each(
                [&](ecs::Entity, const scene::GhostPart& ghost, const scene::Transform& at) {
                    if (ghost.shown) poses.push_back(at.world);
                });
        }
        REQUIRE(driver.lesson().guidance.hints.shown);
        REQUIRE(driver.lesson().guidance.hints.shown->level == level);
        REQUIRE(poses.size() >= 10);
        return poses;
    };
    const auto moves = [](const std::vector<glm::mat4>& poses) {
        return std::any_of(poses.begin(), poses.end(), [&](const glm::mat4& at) { return at != poses[0]; });
    };
    CHECK_FALSE(moves(ghosts(2)));
    CHECK(moves(ghosts(3)));
}

TEST_CASE("Labels: the name of the due joint covers no other nut from any viewpoint") {
    test::HeadlessTrainer driver(options(lesson::Mode::guided, false, "seen-names"));
    const auto fonts = text::load_fonts();
    REQUIRE(fonts);
    driver.frame();
    int named = 0;
    for (int turn = 0; turn < 8; ++turn) {  // so that nuts overlap in the picture
        const double down = turn == 4 ? 10.0 : 0.0, aside = turn < 4 ? 7.5 : -7.5;
        driver.press({300.0, 150.0});
        driver.move({300.0 - aside, 150.0 - down});
        driver.release({300.0 - aside, 150.0 - down});
        driver.wait(0.5);  // until the camera has arrived
        const ActiveLesson& p = driver.lesson();
        const std::size_t due = p.session->lesson().due()->joint;
        const glm::vec2 picture(320.0F, 180.0F);
        for (const render::Label& label : p.scene.labels) {
            const view::LabelBox box = view::box_of(*fonts, label, driver.projection().eye, picture);
            for (std::size_t i = 0; box.visible && i < p.session->setup().nuts.size(); ++i) {
                const auto nut =
                    project(driver.projection(), servo::nut_centre(p.session->setup().nuts[i], 0.0));
                if (i == due || !nut) continue;
                const glm::vec2 at(*nut);
                ++named;
                CAPTURE(turn);
                CHECK_FALSE((at.x > box.low.x && at.x < box.high.x && at.y > box.low.y && at.y < box.high.y));
            }
        }
    }
    CHECK(named > 8);
}
