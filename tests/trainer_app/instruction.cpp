// The author's instruction at the beginning of a pass.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

constexpr test::Display readable{{640, 360}, 0.6F};

// One joint of cover-m8 whose first pass has an instruction with view and picture, and the second a text
// only.
struct InstructedJoint : test::OneJoint {
    InstructedJoint() : OneJoint("cover-m8") {
        const std::filesystem::path one = name();
        nlohmann::json file = nlohmann::json::parse(std::ifstream(one / "assembly.json"));
        file["passes"][0]["instruction"] = {
            {"text", {{"en", "Clean the thread first."}, {"de", "Zuerst reinigen."}}},
            {"view", "top"},
            {"picture", "clean.png"}};
        file["passes"][1]["instruction"] = {{"text", {{"en", "Now with the wrench."}}}};
        std::ofstream(one / "assembly.json") << file;
        std::vector<std::uint8_t> pixels;  // pure magenta, which no part of the scene has
        for (int i = 0; i < 64 * 32; ++i) pixels.insert(pixels.end(), {255, 0, 255});
        const auto png = assets::encode_png(64, 32, 3, pixels);
        REQUIRE(png);
        std::ofstream(one / "clean.png", std::ios::binary) << *png;
    }
};

AppOptions instructed(const InstructedJoint& joint, const char* folder) {
    AppOptions o = test::options(joint.name().c_str(), false);
    o.choice.language = "en";
    o.lesson.obstacles = session::ObstacleUse::none;
    o.out = std::filesystem::path(BOLT_TRAINER_OUT) / folder;
    return o;
}

int magenta_pixels(const render::Picture& picture) {
    int count = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        count += picture.rgba[i] > 240 && picture.rgba[i + 1] < 15 && picture.rgba[i + 2] > 240 ? 1 : 0;
    return count;
}

bool offers_to_go_on(const test::HeadlessTrainer& driver) {
    const auto& drawn = driver.app().drawn_widgets();
    return std::any_of(drawn.begin(), drawn.end(),
                       [](const DrawnWidget& w) { return w.label == words::TextKey("menu.go_on"); });
}

}  // namespace

TEST_CASE(
    "Instruction: a pass with one pauses the lesson, shows text, picture and view, and goes on when told") {
    const InstructedJoint joint;
    test::HeadlessTrainer driver(instructed(joint, "instruction"), readable);
    driver.frame();
    driver.frame();
    const Guidance& guidance = driver.lesson().guidance;
    REQUIRE(guidance.instruction.shown != nullptr);
    CHECK(guidance.instruction.shown->text.at("en") == "Clean the thread first.");
    CHECK(driver.lesson().clock.paused);
    const double paused = driver.lesson().session->time();
    for (int i = 0; i < 30; ++i) driver.frame();
    CHECK(driver.lesson().session->time() == paused);
    CHECK(driver.lesson().view.camera.goal.target.y == doctest::Approx(0.01));  // the view "top"
    CHECK(offers_to_go_on(driver));
    CHECK(magenta_pixels(driver.picture()) > 500);
    driver.lose_gpu();
    for (int i = 0; i < 3; ++i) driver.frame();  // the new interface first measures its page
    CHECK(magenta_pixels(driver.picture()) > 500);
    SUBCASE("by its button") { driver.press_button("menu.go_on"); }
    SUBCASE("by Enter") { driver.key(platform::Key::enter); }
    driver.frame();
    CHECK(guidance.instruction.shown == nullptr);
    CHECK(magenta_pixels(driver.picture()) == 0);
    driver.frame();
    CHECK(driver.lesson().session->time() > paused);
    // A later pause shows the menu of the pause, not the instruction.
    driver.key(platform::Key::escape);
    driver.frame();
    CHECK(driver.lesson().clock.paused);
    CHECK(guidance.instruction.shown == nullptr);
}

TEST_CASE("Instruction: a page appears once for each pass, in the order of the passes") {
    const InstructedJoint joint;
    const content::LoadedAssembly loaded = content::load_assembly(joint.name());
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    REQUIRE(loaded.ok());
    lesson::Lesson lesson = lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
    InstructionState state;
    CHECK_FALSE(update(state, lesson, true));  // paused by the touch check of an arm, which comes first
    CHECK(state.shown == nullptr);
    CHECK(update(state, lesson, false));
    CHECK_FALSE(update(state, lesson, true));
    CHECK(state.shown == &loaded.assembly.passes[0].instruction);
    CHECK_FALSE(update(state, lesson, false));
    CHECK(state.shown == nullptr);
    lesson.current = 1;
    CHECK(update(state, lesson, false));
    CHECK(state.shown == &loaded.assembly.passes[1].instruction);
    CHECK_FALSE(update(state, lesson, false));
    lesson.current = 0;  // undone
    CHECK_FALSE(update(state, lesson, false));
    lesson.current = 1;
    CHECK_FALSE(update(state, lesson, false));
}
