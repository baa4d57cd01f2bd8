// Lessons whose joints need different tools, by simulated trainees, and their replay.
#include <doctest/doctest.h>

#include <set>

#include "tests/lesson/played_session.hpp"
#include "tests/lesson/three_tools.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace bolt::lesson::several_tools {

namespace {

struct Played {
    test::PlayedSession session;
    std::set<std::size_t> tools;  // with which a nut was turned
    bool matching = true;         // each nut was turned with its own tool
};

Played play(const char* profile, const session::LessonOptions& options, const content::Assembly& cover) {
    Played played;
    played.session = test::play_and_replay(
        cover, options, profile, test::setup_from_memory(cover, options),
        [&](const session::ReplayTick& tick) {
            if (tick.output.joint < 0 || tick.input.grip != servo::Grip::wrench) return;
            const auto joint = static_cast<std::size_t>(tick.output.joint);
            played.tools.insert(tick.setup.tool);
            played.matching = played.matching && tick.setup.nuts[joint].tool == tick.setup.tool;
        });
    return played;
}

}  // namespace

TEST_CASE("Several tools: every trainee finishes with the right tool on each nut, and the session replays") {
    const content::Assembly cover = test::cover_with_three_tools();
    for (const char* profile : {"expert", "novice", "clumsy"})
        for (const auto obstacles : {session::ObstacleUse::none, session::ObstacleUse::required}) {
            if (test::sanitized && obstacles == session::ObstacleUse::required) {
                test::skip_part("a lesson among obstacles takes minutes under a sanitizer");
                continue;
            }
            CAPTURE(profile);
            session::LessonOptions options;
            options.seed = 5;
            options.obstacles = obstacles;
            const Played played = play(profile, options, cover);
            REQUIRE(played.session.result.joints.size() == 4);
            for (const JointResult& joint : played.session.result.joints)
                CHECK(joint.torque_verdict != Verdict::low);
            CHECK(played.tools.size() == 3);
            CHECK(played.matching);
            CHECK(played.session.mismatches == 0);
        }
}

TEST_CASE("Several tools: loosening, with the ratchet's lever the other way") {
    session::LessonOptions options;
    options.task = Task::loosen;
    const Played played = play("expert", options, test::cover_with_three_tools());
    CHECK(played.tools.size() == 3);
    CHECK(played.matching);
    CHECK(played.session.mismatches == 0);
}

}  // namespace bolt::lesson::several_tools
