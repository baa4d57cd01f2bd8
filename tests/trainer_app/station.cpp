// The program at a station: what it takes from devices, says of them, and leaves when they fail.
#include <doctest/doctest.h>

#include "game/session/session_file.hpp"
#include "tests/station/virtual_bench.hpp"
#include "tests/trainer_app/desk.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::Desk;

namespace {

struct AtBench {
    test::VirtualBench* bench = nullptr;
    std::optional<station::DisplayedHand> gloved;

    std::optional<Error> refuses;

    AppOptions options(bool menu) {
        AppOptions o = test::options("cover-m8", menu);
        o.choice.with.keyboard = true;
        o.station = [this](const content::Assembly& assembly, const session::CourseOptions& course,
                           const Equipment&,
                           const std::string&) -> Result<std::unique_ptr<station_setup::Bench>> {
            if (refuses) return fail(*refuses);
            auto prepared = session::prepare(assembly, course);
            if (!prepared) return fail(prepared.error());
            auto made = std::make_unique<test::VirtualBench>(std::move(*prepared), course);
            bench = made.get();
            bench->hand_ = gloved;

            return made;
        };
        return o;
    }
    // A picture, and the time until the next.
    void frame(Desk& desk, const std::vector<platform::Event>& events = {}) {
        bench->pass(0.1);
        desk.frame(events);
    }
};

platform::Event down(platform::Key key) { return platform::KeyEvent{key, true, false, {}}; }
platform::Event up(platform::Key key) { return platform::KeyEvent{key, false, false, {}}; }

}  // namespace

TEST_CASE(
    "a station's lesson: keys move the tool, a pause stops it, its end is kept with how it was played") {
    AtBench at;
    Desk desk(at.options(true));
    desk.frame();
    desk.push("menu.start");
    REQUIRE(at.bench != nullptr);
    for (int i = 0; i < 5; ++i) at.frame(desk);
    REQUIRE(desk.app().shows() == Shows::lesson);
    REQUIRE(desk.playing().station);
    CHECK(desk.playing().course->time() > 0.3);
    CHECK(desk.playing().coaching.hints.shown.has_value());
    const Vec3 home = desk.playing().station->home.position;
    CHECK(glm::distance(hand_of(desk.playing()).pose.position, home) < 0.05);
    at.frame(desk, {down(platform::Key::e)});
    for (int i = 0; i < 5; ++i) at.frame(desk);
    at.frame(desk, {up(platform::Key::e)});
    CHECK(hand_of(desk.playing()).pose.position.y > home.y + 0.05);
    at.frame(desk, {down(platform::Key::escape)});
    at.frame(desk, {up(platform::Key::escape)});
    const double paused = desk.playing().course->time();
    for (int i = 0; i < 3; ++i) at.frame(desk);
    CHECK(desk.playing().course->time() == paused);
    desk.push("menu.end");
    desk.frame();
    REQUIRE(desk.played());
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->header().servo == "1000 Hz");
    CHECK(reader->tick_count() == static_cast<std::uint64_t>(std::lround(paused * 1000.0)));
}

TEST_CASE("what is pressed at a station goes out with that frame, and the next picture shows it") {
    AtBench at;
    Desk desk(at.options(false));
    desk.frame();
    for (int i = 0; i < 3; ++i) at.frame(desk);
    const Vec3 before = hand_of(desk.playing()).pose.position;
    desk.frame({down(platform::Key::e)});
    at.bench->pass(0.02);
    desk.frame();
    CHECK(hand_of(desk.playing()).pose.position.y > before.y + 1e-3);
}

TEST_CASE("a station that does not come up is told of in the menu, and the mouse is still there") {
    AtBench at;
    at.refuses.emplace();
    at.refuses->code = ErrorCode::no_device;
    at.refuses->what = "the arm is not plugged in";
    Desk desk(at.options(true));
    desk.frame();
    desk.push("menu.start");
    desk.frame();
    CHECK(desk.app().shows() == Shows::menu);
    REQUIRE(desk.app().trouble());
    CHECK(desk.app().trouble()->what == "the arm is not plugged in");
}

TEST_CASE("ticks that were lost end the lesson in words, and the session until then is whole") {
    AtBench at;
    Desk desk(at.options(false));
    desk.frame();
    for (int i = 0; i < 5; ++i) at.frame(desk);
    at.bench->lost_ = 3;
    at.bench->pass(0.1);
    const Status status = desk.try_frame();
    REQUIRE_FALSE(status);
    CHECK(status.error().message().find("3 ticks") != std::string::npos);
    REQUIRE(desk.app().end_lesson());
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->tick_count() >= 500);
}

TEST_CASE("a glove of the left hand: the wrench lies for that one, and the session says so") {
    const auto rests_at = [](std::optional<station::DisplayedHand> gloved) {
        AtBench at;
        at.gloved = gloved;
        Desk desk(at.options(false));
        desk.frame();
        const ActiveLesson& p = desk.playing();
        const double middle = 0.5 * static_cast<double>(p.place.machine.low.x + p.place.machine.high.x);
        const Vec3 grip(p.course->setup().wrench.handle_length, 0.0, 0.0);
        const double aside = (p.station->rest * grip).x - middle;
        REQUIRE(desk.app().end_lesson());
        const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
        REQUIRE(reader);
        CHECK(reader->header().hand == (gloved ? "left" : "right"));
        return aside;
    };
    station::DisplayedHand left;
    left.side = hand::Side::left;
    const double bare = rests_at({});
    CHECK(bare > 0.1);
    CHECK(rests_at(left) == doctest::Approx(-bare));
}
