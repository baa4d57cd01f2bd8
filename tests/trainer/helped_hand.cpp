#include "game/trainer/helped_hand.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/lesson/left_threads.hpp"
#include "tests/lesson/three_tools.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;
using namespace trainer_test;
using trainer::HandAction;

namespace {

void apply_next_command(Player& player, const session::LessonSession& session) {
    trainer::MouseCommand command = next_command(player, session, 0.016);
    command.tool = session.due_tool();
    trainer::apply_command(player.hand, command, session.setup(), session.state());
}

struct Outcome {
    lesson::LessonResult result;
    double time = 0.0;
    int presses = 0;
    double longest_jump = 0.0;  // m per tick, of the hand
};

Outcome play_through(const content::Assembly& lesson, session::LessonOptions options, double longest) {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    options.trainee_profile = "person";
    auto begun = session::LessonSession::begin(lesson, options, file);
    REQUIRE(begun);
    session::LessonSession& session = **begun;
    world::World world;
    world::add_haptics(world, session.state());
    Player player;
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    Outcome out;
    Vec3 before = player.hand.pose.position;
    for (std::uint64_t tick = 0; !session.finished() && session.time() < longest; ++tick) {
        if (tick % 16 == 0) apply_next_command(player, session);
        const servo::TickInput input = trainer::step_hand(player.hand, session.setup(), session.state());
        REQUIRE(session.tick(world, input));
        out.longest_jump = std::max(out.longest_jump, glm::distance(before, player.hand.pose.position));
        before = player.hand.pose.position;
    }
    const auto played = session.finish(world);
    REQUIRE(played);
    out.result = played->result;
    out.time = session.time();
    out.presses = player.presses;
    begun->reset();  // closes the session file
    std::filesystem::remove(file);
    return out;
}

}  // namespace

TEST_CASE("Helped hand: it changes the tool at rest when a nut needs another one") {
    for (const auto obstacles : {session::ObstacleUse::none, session::ObstacleUse::required}) {
        session::LessonOptions options;
        options.obstacles = obstacles;
        const Outcome out = play_through(test::cover_with_three_tools(), options, 400.0);
        REQUIRE(out.result.joints.size() == 4);
        for (const lesson::JointResult& joint : out.result.joints)
            CHECK(joint.torque_verdict == lesson::Verdict::ok);
        CHECK(out.longest_jump < 5e-3);
    }
}

TEST_CASE("Helped hand: it tightens left-hand threads beside right-hand ones") {
    for (const char* tool : {"", "ratchet"}) {
        const test::Folder folder;
        session::LessonOptions options;
        options.obstacles = session::ObstacleUse::required;
        const Outcome out = play_through(test::cover_with_left_threads(folder, tool), options, 400.0);
        CHECK(out.result.finished);
        for (const lesson::JointResult& joint : out.result.joints)
            CHECK(joint.torque_verdict == lesson::Verdict::ok);
        CHECK(out.longest_jump < 5e-3);
    }
}

TEST_CASE("Helped hand: a lesson is played from beginning to end") {
    session::LessonOptions options;
    SUBCASE("among obstacles") { options.obstacles = session::ObstacleUse::required; }
    SUBCASE("without obstacles") {}
    SUBCASE("in practice mode") { options.mode = lesson::Mode::practice; }
    SUBCASE("loosening") {
        options.task = lesson::Task::loosen;
        options.obstacles = session::ObstacleUse::required;
    }
    const char* name = "cover-m8";
    SUBCASE("the reducer, tightened into yield") {
        if (test::sanitized) return test::skip_rest("sixty steps take minutes under a sanitizer");
        name = "zq350";
        options.obstacles = session::ObstacleUse::required;
    }
    const Outcome out = play_through(assembly(name), options, 1200.0);
    CHECK(out.result.finished);
    CHECK(out.result.score > 90.0);
    CHECK(out.longest_jump < 5e-3);  // 5 m/s: the hand does not jump
    MESSAGE(out.time << " s, " << out.presses << " presses, score " << out.result.score);
}
