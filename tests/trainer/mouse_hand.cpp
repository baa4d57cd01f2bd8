#include "game/trainer/mouse_hand.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;
using namespace trainer_test;
using trainer::Doing;

namespace {

struct Outcome {
    lesson::LessonResult result;
    double time = 0.0;
    int presses = 0;
    double longest_jump = 0.0;  // m in a tick, of the hand
};

Outcome play_through(const char* name, session::CourseOptions options, double longest) {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    options.operator_name = "person";
    auto begun = session::Course::begin(assembly(name), options, file);
    REQUIRE(begun);
    session::Course& course = **begun;
    Player player;
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    Outcome out;
    Vec3 before = player.hand.pose.position;
    for (std::uint64_t tick = 0; !course.over() && course.time() < longest; ++tick) {
        if (tick % 16 == 0)
            trainer::wish(player.hand, wish_of(player, course, 0.016), course.setup(), course.state());
        const servo::Input input = trainer::move(player.hand, course.setup(), course.state());
        REQUIRE(course.step(input));
        out.longest_jump = std::max(out.longest_jump, glm::distance(before, player.hand.pose.position));
        before = player.hand.pose.position;
    }
    const auto played = course.finish();
    REQUIRE(played);
    out.result = played->result;
    out.time = course.time();
    out.presses = player.presses;
    begun->reset();  // the session is closed, and can go
    std::filesystem::remove(file);
    return out;
}

}  // namespace

TEST_CASE("a lesson is played from beginning to end with a mouse") {
    session::CourseOptions options;
    SUBCASE("among obstacles") { options.obstacles = session::Obstacles::required; }
    SUBCASE("without") {}
    SUBCASE("not guided") { options.mode = lesson::Mode::practice; }
    SUBCASE("loosened again") {
        options.task = lesson::Task::loosen;
        options.obstacles = session::Obstacles::required;
    }
    const char* name = "cover-m8";
    SUBCASE("the reducer, into yield") {
        if (test::sanitized) return test::skip_rest("sixty steps take minutes under a sanitizer");
        name = "zq350";
        options.obstacles = session::Obstacles::required;
    }
    const Outcome out = play_through(name, options, 1200.0);
    CHECK(out.result.finished);
    CHECK(out.result.score > 90.0);
    CHECK(out.longest_jump < 5e-3);  // 5 m/s: no hand jumps
    MESSAGE(out.time << " s, " << out.presses << " presses, score " << out.result.score);
}
