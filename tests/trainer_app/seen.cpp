// What is shown over and beside the work: the close-up and hints in the scene, and the machine behind the
// menu.
#include <algorithm>
#include <thread>

#include "game/view/labels.hpp"
#include "tests/trainer_app/desk.hpp"

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

// With the wrench on the first nut.
void put_on(test::Desk& one) {
    one.frame();
    one.key(platform::Key::t);
    for (int i = 0; i < 40 && !hand_of(one.playing()).wrench; ++i) one.frame({}, 0.25);
    REQUIRE(hand_of(one.playing()).wrench);
}

// Of the picture's pixels those that are not as in the other.
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
    const_cast<scene::World&>(p.place.world).view<const scene::Pointer>().each([&](const scene::Pointer& it) {
        shown = shown || (it.shown && it.shape == scene::ArrowShape::straight);
    });
    return shown;
}

}  // namespace

TEST_CASE(
    "the close-up comes with the wrench at a nut, goes by its key and with the wrench, and looks from "
    "above") {
    test::Desk one(options(lesson::Mode::guided, false, "seen-guided"), big_letters);
    put_on(one);
    CHECK_FALSE(one.playing().view.close_up.joint);  // far away
    one.key(platform::Key::h);
    one.key(platform::Key::h);
    one.frame();
    CHECK(straight_arrow_shown(one.playing()));
    const std::size_t joint = one.playing().course->lesson().due()->joint;
    one.key(platform::Key::v);
    for (int i = 0; i < 4; ++i) one.frame({}, 0.25);
    const glm::dvec2 at = one.hold(joint);
    const CloseUp& c = one.playing().view.close_up;
    REQUIRE(c.joint == joint);
    CHECK(c.seen >= 0.6);
    const servo::NutGeometry& nut = one.playing().course->setup().nuts[joint];
    CHECK(glm::dot(c.tool * c.eye - c.tool.position, nut.axis) > 0.03);
    one.wait(0.6);
    one.frame({}, 0.001);
    const render::Picture with = one.picture();
    const auto place = close_up_place(glm::dvec2(big_letters.size.width, big_letters.size.height), 0.5F, {});
    REQUIRE(place);
    one.frame({platform::KeyEvent{platform::Key::i, true, false, {}}}, 0.001);
    CHECK_FALSE(c.joint);
    const render::Picture without = one.picture();
    CHECK(share_changed(with, without, *place) > 0.5);
    CHECK(share_changed(with, without, {{170.0F, 70.0F}, {320.0F, 120.0F}}) < 0.05);
    one.key(platform::Key::i);
    CHECK(c.joint == joint);
    one.release(at);
    one.wait(1.0);
    one.key(platform::Key::t);
    for (int i = 0; i < 12; ++i) one.frame({}, 0.25);
    CHECK_FALSE(c.joint);
}

TEST_CASE("in an assessment there is no close-up, whatever is pressed, and no arrow") {
    test::Desk one(options(lesson::Mode::assessment, false, "seen-assessment"), big_letters);
    put_on(one);
    one.key(platform::Key::i);
    one.key(platform::Key::h);
    one.hold(0);
    one.frame();
    CHECK_FALSE(one.playing().view.close_up.joint);
    CHECK_FALSE(straight_arrow_shown(one.playing()));
}

TEST_CASE("behind the menu stands the machine that is chosen, and the menu does not wait for it") {
    test::Desk one(options(lesson::Mode::guided, true, "seen-menu"), big_letters);
    one.frame();
    const render::Picture bare = one.picture();
    CHECK(one.app().shows() == Shows::menu);
    for (int i = 0; i < 2000 && one.app().backdrop().reading(); ++i) {
        one.frame();
        std::this_thread::yield();
    }
    REQUIRE_FALSE(one.app().backdrop().reading());
    one.frame();
    const render::Rectangle beside{{0.0F, 0.0F}, {60.0F, 180.0F}};
    CHECK(share_changed(bare, one.picture(), beside) > 0.5);
}

TEST_CASE("a hint is read in full from its first picture on") {
    test::Desk one(options(lesson::Mode::guided, false, "seen-hint"), big_letters);
    one.frame();
    const auto hint_plate = [&]() -> std::optional<render::Rectangle> {
        for (const render::Rectangle& plate : one.playing().view.occupied)
            if (plate.low.y < 10.0F && plate.high.x > 0.6F * 320.0F) return plate;
        return std::nullopt;
    };
    const words::Loaded en = words::load_words(words::words_folder(), "en");
    int changed = 0;
    std::string said;
    std::optional<render::Rectangle> first;
    for (int i = 0; i < 120 && changed < 3; ++i) {
        if (i == 60) one.key(platform::Key::h);
        one.frame();
        const auto& hint = one.playing().coaching.hints.shown;
        const std::string now = hint ? lesson::say(en.words, *hint) + std::to_string(hint->level) : "";
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

TEST_CASE("the name of what is due stands over no other nut, wherever one looks from") {
    test::Desk one(options(lesson::Mode::guided, false, "seen-names"));
    const auto fonts = text::load_fonts();
    REQUIRE(fonts);
    one.frame();
    int named = 0;
    for (int turn = 0; turn < 8; ++turn) {  // so that nuts come to stand behind nuts
        const double down = turn == 4 ? 10.0 : 0.0, aside = turn < 4 ? 7.5 : -7.5;
        one.press({300.0, 150.0});
        one.move({300.0 - aside, 150.0 - down});
        one.release({300.0 - aside, 150.0 - down});
        one.wait(0.5);  // it has glided there
        const ActiveLesson& p = one.playing();
        const std::size_t due = p.course->lesson().due()->joint;
        const glm::vec2 picture(320.0F, 180.0F);
        for (const render::Label& label : p.scene.labels) {
            const view::LabelBox box = view::box_of(*fonts, label, one.screen().eye, picture);
            for (std::size_t i = 0; box.seen && i < p.course->setup().nuts.size(); ++i) {
                const auto nut = project(one.screen(), servo::nut_centre(p.course->setup().nuts[i], 0.0));
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
