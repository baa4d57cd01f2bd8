// Lessons among obstacles: simulated trainees see them, reach round, bump, are guided and slide on.
#include <algorithm>
#include <filesystem>
#include <string>

#include "game/lesson/lesson.hpp"
#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

struct Played {
    bool done = false;
    double seconds = 0.0;
    double searching = 0.0;    // s, the wrench near the due nut and not on it
    double step = 0.0;         // N, the greatest change of the force in a tick
    double torque_step = 0.0;  // N·m
    int slips = 0;
    double deepest = 1.0;      // m
    int bumps = 0;             // times that the wrench came to touch something with no nut in its jaw
    std::uint64_t faults = 0;  // of the watchdog
};

Played play_through(test::Workbench& bench, const char* trainee, std::uint64_t seed, bool guides = true,
                    std::size_t steps = 1000) {
    lesson::Lesson lesson = lesson::begin(bench.assembly, lesson::Mode::guided, lesson::Task::tighten);
    lesson.guides = guides;
    trainees::Operator hand(trainees::find_profile(trainee).value(), seed, bench.setup);
    Played played;
    Output before;
    bool touched = false;
    while (lesson.due() != nullptr && lesson.current < steps && bench.state.tick < 600'000) {
        const Output output = tick(bench.setup, bench.state, hand.act(bench.setup, bench.state, lesson));
        lesson::observe(lesson, bench.state, output);
        lesson.events.clear();
        if (output.joint < 0 && bench.state.tool_contact->in_hand && lesson.due() != nullptr) {
            const std::size_t due = lesson.due()->joint;
            const Vec3 nut = nut_centre(bench.setup.nuts[due], bench.state.joints[due].nut.angle);
            if (glm::length(output.tool.position - nut) < 0.04) played.searching += bench.setup.dt;
        }
        played.step = std::max(played.step, glm::length(output.force - before.force));
        played.torque_step = std::max(played.torque_step, glm::length(output.torque - before.torque));
        if (output.slipped >= 0) ++played.slips;
        if (output.contacts > 0)
            played.deepest = std::min(played.deepest, bench.state.tool_contact->last_step.nearest);
        const bool touches =
            output.contacts > 0 && bench.state.tool_contact->last_step.nearest < 0.1e-3 && output.joint < 0;
        if (touches && !touched) ++played.bumps;
        touched = touches;
        if (output.fault != force::Fault::none) ++played.faults;
        before = output;
    }
    played.done = lesson.due() == nullptr;
    played.seconds = static_cast<double>(bench.state.tick) * bench.setup.dt;
    return played;
}

}  // namespace

TEST_CASE("Tool contact: trainees finish a lesson among obstacles without a shock") {
    for (const std::string trainee : {"clumsy", "expert"}) {
        if (test::sanitized && trainee == "expert") {
            test::skip_part("the expert's lesson takes minutes under a sanitizer");
            continue;
        }
        test::Workbench bench("cover-m8");
        const Played played = play_through(bench, trainee.c_str(), 3);
        MESSAGE(trainee << ": " << played.seconds << " s, " << played.bumps << " bumps, greatest step "
                        << played.step << " N and " << played.torque_step << " N m, " << played.slips
                        << " slips");
        CHECK(played.done);
        // Well below what the output stage lets through of a leap, a tenth: nothing leaps.
        CHECK(played.step < 0.06 * bench.setup.limits.force);
        CHECK(played.slips == 0);
        CHECK(played.deepest > -0.1e-3);
        CHECK(played.faults == 0);
    }
}

TEST_CASE(
    "Tool contact: a badly placed wrench is guided onto the nut, and searches for it without guiding force") {
    if (test::sanitized) return test::skip_rest("four lessons take minutes under a sanitizer");
    double led = 0.0, alone = 0.0;
    for (const std::uint64_t seed : {1U, 2U}) {
        test::Workbench first("cover-m8"), second("cover-m8");
        led += play_through(first, "clumsy", seed, true, 10).searching;
        alone += play_through(second, "clumsy", seed, false, 10).searching;
    }
    MESSAGE("near the nuts: guided " << led << " s, not guided " << alone << " s");
    CHECK(led < 0.8 * alone);
}

TEST_CASE("Tool contact: a lesson among obstacles replays to the same bits") {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    const content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("novice").value();
    options.course.seed = 3;
    options.course.obstacles = session::Obstacles::required;
    options.longest = 60.0;
    REQUIRE(trainees::train(loaded.assembly, options, file, [](const trainees::Progress&) { return true; }));
    const auto reader = session::Reader::open(file);
    REQUIRE(reader);
    auto at = session::prepare_again(*reader);
    REQUIRE(at);
    CHECK(at->obstacles == reader->header().obstacles);
    CHECK(at->obstacle_names.size() == reader->header().obstacle_names.size());
    std::uint64_t touched = 0;
    const auto replayed = session::replay(*reader, std::move(*at), [&](const session::Moment& moment) {
        touched += moment.output.touched.is_none() ? 0U : 1U;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->ticks == reader->tick_count());
    CHECK(replayed->ticks > 50'000);
    CHECK(touched > 200);
    CHECK(replayed->wrong == 0);
    std::filesystem::remove(file);
}
