// The trainer at a station: input from devices, messages about them, and the session after they fail.
#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "content/format/folders.hpp"
#include "game/session/session_file.hpp"
#include "tests/station/virtual_time_station.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

struct AtBench {
    test::VirtualTimeStation* bench = nullptr;
    std::optional<station::DisplayedHand> gloved;

    std::optional<Error> refuses;
    std::vector<Equipment> started;  // of each lesson

    AppOptions options(bool menu) {
        AppOptions o = test::options("cover-m8", menu);
        o.choice.equipment.hand = HandMode::keyboard;
        o.start_station =
            [this](const content::Assembly& assembly, const session::LessonOptions& lesson_options,
                   const Equipment& equipment, const std::string&,
                   const device::ArmDialog&) -> Result<std::unique_ptr<station_setup::LessonStation>> {
            started.push_back(equipment);
            if (refuses) return fail(*refuses);
            auto prepared = session::prepare_session(assembly, lesson_options);
            if (!prepared) return fail(prepared.error());
            auto made = std::make_unique<test::VirtualTimeStation>(std::move(*prepared), lesson_options);
            bench = made.get();
            bench->hand_ = gloved;

            return made;
        };
        return o;
    }
    // Lets time pass until the next frame, then records it.
    void frame(HeadlessTrainer& driver, const std::vector<platform::InputEvent>& events = {}) {
        bench->advance(0.1);
        driver.frame(events);
    }
};

platform::InputEvent down(platform::Key key) { return platform::KeyEvent{key, true, false, {}}; }
platform::InputEvent up(platform::Key key) { return platform::KeyEvent{key, false, false, {}}; }

}  // namespace

TEST_CASE("Trainer at a station: keys move the tool, a pause stops it, and the session records the servo") {
    AtBench at;
    HeadlessTrainer driver(at.options(true));
    driver.frame();
    driver.press_button("menu.start");
    REQUIRE(at.bench != nullptr);
    for (int i = 0; i < 5; ++i) at.frame(driver);
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    REQUIRE(driver.lesson().station);
    CHECK(driver.lesson().session->time() > 0.3);
    CHECK(driver.lesson().guidance.hints.shown.has_value());
    const Vec3 home = driver.lesson().station->home.position;
    CHECK(glm::distance(hand_of(driver.lesson()).pose.position, home) < 0.05);
    at.frame(driver, {down(platform::Key::e)});
    for (int i = 0; i < 5; ++i) at.frame(driver);
    at.frame(driver, {up(platform::Key::e)});
    CHECK(hand_of(driver.lesson()).pose.position.y > home.y + 0.05);
    at.frame(driver, {down(platform::Key::escape)});
    at.frame(driver, {up(platform::Key::escape)});
    const double paused = driver.lesson().session->time();
    for (int i = 0; i < 3; ++i) at.frame(driver);
    CHECK(driver.lesson().session->time() == paused);
    driver.press_button("menu.end");
    driver.frame();
    REQUIRE(driver.outcome());
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->header().servo_rate == 1000.0);
    CHECK(reader->tick_count() == static_cast<std::uint64_t>(std::lround(paused * 1000.0)));
}

TEST_CASE(
    "Trainer at a station: every lesson gets what the station file says, also one that is started again") {
    AtBench at;
    AppOptions options = at.options(true);
    content::StationFile& station = options.choice.equipment.station;
    station.arm.emplace().device = "force-dimension:0";
    station.arm->limits.force = 5.0;
    station.arm->mounting.yaw = pi;
    HeadlessTrainer driver(std::move(options));
    driver.frame();
    driver.press_button("menu.start");
    for (int i = 0; i < 3; ++i) at.frame(driver);
    at.frame(driver, {down(platform::Key::escape)});
    at.frame(driver, {up(platform::Key::escape)});
    driver.press_button("menu.end");
    driver.frame();
    driver.press_button("menu.again");
    driver.frame();
    REQUIRE(at.started.size() == 2);
    for (const Equipment& equipment : at.started) {
        REQUIRE(equipment.station.arm);
        CHECK(equipment.station.arm->limits.force == 5.0);
        CHECK(equipment.station.arm->mounting.yaw == pi);
    }
}

TEST_CASE("Trainer at a station: the tool of the station's arm is chosen where the assembly has it") {
    const content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder("cover-m8"));
    REQUIRE(loaded.ok());
    const std::vector<content::Tool>& tools = loaded.assembly.tools;
    REQUIRE(tools.size() == 2);
    content::StationFile station;
    CHECK(tool_of_station(station, tools) == std::string());
    station.arm.emplace().tool = tools[0].name;
    CHECK(tool_of_station(station, tools) == std::string());
    station.arm->tool = tools[1].name;
    CHECK(tool_of_station(station, tools) == tools[1].name);
    station.arm->tool = "spanner";
    const Result<std::string> none = tool_of_station(station, tools);
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::bad_content);
    CHECK(none.error().expected.find(tools[1].name) != std::string::npos);
}

TEST_CASE("Trainer at a station: a key is sent with its frame, and the next picture shows the effect") {
    AtBench at;
    HeadlessTrainer driver(at.options(false));
    driver.frame();
    for (int i = 0; i < 3; ++i) at.frame(driver);
    const Vec3 before = hand_of(driver.lesson()).pose.position;
    driver.frame({down(platform::Key::e)});
    at.bench->advance(0.02);
    driver.frame();
    CHECK(hand_of(driver.lesson()).pose.position.y > before.y + 1e-3);
}

TEST_CASE("Trainer at a station: a station that fails to start is reported in the menu") {
    AtBench at;
    at.refuses.emplace();
    at.refuses->code = ErrorCode::no_device;
    at.refuses->what = "the arm is not plugged in";
    HeadlessTrainer driver(at.options(true));
    driver.frame();
    driver.press_button("menu.start");
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    REQUIRE(driver.app().start_error());
    CHECK(driver.app().start_error()->what == "the arm is not plugged in");
}

TEST_CASE(
    "Trainer at a station: dropped ticks end the lesson with an error, and the session up to there is "
    "complete") {
    AtBench at;
    HeadlessTrainer driver(at.options(false));
    driver.frame();
    for (int i = 0; i < 5; ++i) at.frame(driver);
    at.bench->lost_ = 3;
    at.bench->advance(0.1);
    const Status status = driver.try_frame();
    REQUIRE_FALSE(status);
    CHECK(status.error().message().find("3 ticks") != std::string::npos);
    REQUIRE(driver.app().end_lesson());
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->tick_count() >= 500);
}

TEST_CASE(
    "Trainer at a station: a left glove puts the wrench on the left, and the session records the hand") {
    const auto rests_at = [](std::optional<station::DisplayedHand> gloved) {
        AtBench at;
        at.gloved = gloved;
        HeadlessTrainer driver(at.options(false));
        driver.frame();
        const ActiveLesson& p = driver.lesson();
        const double middle =
            0.5 * static_cast<double>(p.workplace.workpiece.low.x + p.workplace.workpiece.high.x);
        const Vec3 grip(p.session->setup().wrench.handle_length, 0.0, 0.0);
        const double aside = (p.station->rest * grip).x - middle;
        REQUIRE(driver.app().end_lesson());
        const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
        REQUIRE(reader);
        CHECK(reader->header().hand == (gloved ? hand::Side::left : hand::Side::right));
        return aside;
    };
    station::DisplayedHand left;
    left.side = hand::Side::left;
    const double bare = rests_at({});
    CHECK(bare > 0.1);
    CHECK(rests_at(left) == doctest::Approx(-bare));
}
