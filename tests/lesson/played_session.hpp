// A lesson played by a simulated trainee, and the replay of its session.
#pragma once

#include <doctest/doctest.h>

#include <functional>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"

namespace bolt::test {

struct PlayedSession {
    lesson::LessonResult result;
    std::uint64_t mismatches = 0;  // ticks whose replay differs
};

// The setup in which a session is replayed: its own, or one that is prepared again.
using ReplaySetup = std::function<Result<session::SessionSetup>(const session::SessionReader& reader)>;

// An assembly that a test has changed in memory has another file than its session says, so its setup is
// prepared from memory. `options` and `assembly` must outlive the returned function.
inline ReplaySetup setup_from_memory(const content::Assembly& assembly,
                                     const session::LessonOptions& options) {
    return [&](const session::SessionReader&) { return session::prepare_session(assembly, options); };
}

// Fails the test if the lesson cannot be played or replayed. `watch`: called for each replayed tick.
inline PlayedSession play_and_replay(
    const content::Assembly& assembly, const session::LessonOptions& options, const char* profile,
    const ReplaySetup& setup,
    const std::function<void(const session::ReplayTick&)>& watch = [](const session::ReplayTick&) {}) {
    const Folder folder;
    trainees::TrainOptions train;
    train.lesson = options;
    train.trainee = trainees::find_profile(profile).value();
    const auto outcome = trainees::train(assembly, train, folder / "lesson.boltwright",
                                         [](const trainees::TrainingProgress&) { return true; });
    REQUIRE_MESSAGE(outcome, (outcome ? "" : outcome.error().message()));
    const auto reader = session::SessionReader::open(folder / "lesson.boltwright");
    REQUIRE(reader);
    Result<session::SessionSetup> start = setup(*reader);
    REQUIRE(start);
    const auto replayed = session::replay(*reader, std::move(*start), [&](const session::ReplayTick& tick) {
        watch(tick);
        return true;
    });
    REQUIRE(replayed);
    return {outcome->result, replayed->mismatches};
}

}  // namespace bolt::test
