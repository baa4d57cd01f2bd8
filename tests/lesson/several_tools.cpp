// Lessons whose joints need different tools, by simulated trainees, and their replay.
#include <doctest/doctest.h>

#include <set>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/lesson/three_tools.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace bolt::lesson::several_tools {

namespace {

struct Played {
    LessonResult result;
    std::set<std::size_t> tools;  // with which a nut was turned
    bool matching = true;         // each nut was turned with its own tool
    std::size_t mismatches = 0;
};

// Plays a lesson and replays its session. The file of the assembly has one tool, so the session's setup is
// made again from the assembly in memory.
Played play(const char* profile, const session::LessonOptions& options, const content::Assembly& cover) {
    const test::Folder folder;
    trainees::TrainOptions train;
    train.lesson = options;
    train.trainee = trainees::find_profile(profile).value();
    const auto outcome = trainees::train(cover, train, folder / "lesson.boltwright",
                                         [](const trainees::TrainingProgress&) { return true; });
    REQUIRE_MESSAGE(outcome, (outcome ? "" : outcome.error().message()));
    Played played;
    played.result = outcome->result;
    const auto reader = session::SessionReader::open(folder / "lesson.boltwright");
    REQUIRE(reader);
    auto start = session::prepare_session(cover, options);
    REQUIRE(start);
    const auto replayed = session::replay(*reader, std::move(*start), [&](const session::ReplayTick& tick) {
        if (tick.output.joint < 0 || tick.input.grip != servo::Grip::wrench) return true;
        const auto joint = static_cast<std::size_t>(tick.output.joint);
        played.tools.insert(tick.setup.tool);
        played.matching = played.matching && tick.setup.nuts[joint].tool == tick.setup.tool;
        return true;
    });
    REQUIRE(replayed);
    played.mismatches = replayed->mismatches;
    return played;
}

}  // namespace

TEST_CASE("Several tools: every trainee finishes with the right tool on each nut, and the session replays") {
    const content::Assembly cover = test::cover_with_three_tools();
    for (const char* profile : {"expert", "novice", "clumsy"})
        for (const auto obstacles : {session::Obstacles::none, session::Obstacles::required}) {
            if (test::sanitized && obstacles == session::Obstacles::required) {
                test::skip_part("a lesson among obstacles takes minutes under a sanitizer");
                continue;
            }
            CAPTURE(profile);
            session::LessonOptions options;
            options.seed = 5;
            options.obstacles = obstacles;
            const Played played = play(profile, options, cover);
            REQUIRE(played.result.joints.size() == 4);
            for (const JointResult& joint : played.result.joints) CHECK(joint.torque_verdict != Verdict::low);
            CHECK(played.tools.size() == 3);
            CHECK(played.matching);
            CHECK(played.mismatches == 0);
        }
}

TEST_CASE("Several tools: loosening, with the ratchet's lever the other way") {
    session::LessonOptions options;
    options.task = Task::loosen;
    const Played played = play("expert", options, test::cover_with_three_tools());
    CHECK(played.tools.size() == 3);
    CHECK(played.matching);
    CHECK(played.mismatches == 0);
}

}  // namespace bolt::lesson::several_tools
