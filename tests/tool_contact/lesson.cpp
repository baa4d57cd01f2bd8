// Lessons of simulated trainees with contact simulation.
#include <algorithm>
#include <filesystem>
#include <string>

#include "game/lesson/lesson.hpp"
#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/haptic_world.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

struct LessonStatistics {
    bool done = false;
    double seconds = 0.0;
    double searching = 0.0;    // s with the wrench near the due nut and not on it
    double step = 0.0;         // N, greatest change of the force in a tick
    double torque_step = 0.0;  // N·m
    int slips = 0;
    double deepest = 1.0;      // m
    int bumps = 0;             // contacts that began without a nut in the jaw
    std::uint64_t faults = 0;  // of the watchdog
};

LessonStatistics run_lesson(test::Workbench& bench, const char* trainee, std::uint64_t seed,
                            bool guides = true, std::size_t steps = 1000) {
    world::World world = test::make_world(bench.state);
    lesson::Lesson lesson = lesson::begin(bench.assembly, lesson::Mode::guided, lesson::Task::tighten);
    lesson.guides = guides;
    trainees::SimulatedTrainee hand(trainees::find_profile(trainee).value(), seed, bench.setup);
    LessonStatistics statistics;
    Output before;
    bool touched = false;
    while (lesson.due() != nullptr && lesson.current < steps && bench.state.tick < 600'000) {
        const Output output = tick(bench.setup, bench.state, hand.act(bench.setup, bench.state, lesson));
        test::observe_tick(lesson, world, bench.state, output);
        lesson.events.clear();
        if (output.joint < 0 && bench.state.tool_contact->in_hand && lesson.due() != nullptr) {
            const std::size_t due = lesson.due()->joint;
            const Vec3 nut = nut_centre(bench.setup.nuts[due], bench.state.joints[due].nut.angle);
            if (glm::length(output.constrained_tool.position - nut) < 0.04)
                statistics.searching += bench.setup.dt;
        }
        statistics.step = std::max(statistics.step, glm::length(output.force - before.force));
        statistics.torque_step = std::max(statistics.torque_step, glm::length(output.torque - before.torque));
        if (output.slipped >= 0) ++statistics.slips;
        if (output.contacts > 0)
            statistics.deepest = std::min(statistics.deepest, bench.state.tool_contact->last_step.nearest);
        const bool touches =
            output.contacts > 0 && bench.state.tool_contact->last_step.nearest < 0.1e-3 && output.joint < 0;
        if (touches && !touched) ++statistics.bumps;
        touched = touches;
        if (output.fault != force::Fault::none) ++statistics.faults;
        before = output;
    }
    statistics.done = lesson.due() == nullptr;
    statistics.seconds = static_cast<double>(bench.state.tick) * bench.setup.dt;
    return statistics;
}

}  // namespace

TEST_CASE("Tool contact: trainees finish a lesson among obstacles without a shock") {
    for (const std::string trainee : {"clumsy", "expert"}) {
        if (test::sanitized && trainee == "expert") {
            test::skip_part("the expert's lesson takes minutes under a sanitizer");
            continue;
        }
        test::Workbench bench("cover-m8");
        const LessonStatistics statistics = run_lesson(bench, trainee.c_str(), 3);
        MESSAGE(trainee << ": " << statistics.seconds << " s, " << statistics.bumps
                        << " bumps, greatest step " << statistics.step << " N and " << statistics.torque_step
                        << " N m, " << statistics.slips << " slips");
        CHECK(statistics.done);
        // Well below the output stage's limit of a tenth: there are no jumps.
        CHECK(statistics.step < 0.06 * bench.setup.limits.force);
        CHECK(statistics.slips == 0);
        CHECK(statistics.deepest > -0.1e-3);
        CHECK(statistics.faults == 0);
    }
}

TEST_CASE("Tool contact: the guiding force shortens the search for the nuts by at least a fifth") {
    if (test::sanitized) return test::skip_rest("four lessons take minutes under a sanitizer");
    double guided = 0.0, unguided = 0.0;
    for (const std::uint64_t seed : {1U, 2U}) {
        test::Workbench first("cover-m8"), second("cover-m8");
        guided += run_lesson(first, "clumsy", seed, true, 10).searching;
        unguided += run_lesson(second, "clumsy", seed, false, 10).searching;
    }
    MESSAGE("near the nuts: guided " << guided << " s, not guided " << unguided << " s");
    CHECK(guided < 0.8 * unguided);
}

TEST_CASE("Tool contact: a lesson among obstacles replays to the same bits") {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("novice").value();
    options.lesson.seed = 3;
    options.lesson.obstacles = session::ObstacleUse::required;
    options.time_limit = 60.0;
    REQUIRE(trainees::train(loaded.assembly, options, file,
                            [](const trainees::TrainingProgress&) { return true; }));
    const auto reader = session::SessionReader::open(file);
    REQUIRE(reader);
    auto at = session::restore_setup(*reader);
    REQUIRE(at);
    CHECK(at->contact_models == reader->header().contact_models);
    CHECK(at->obstacle_names.size() == reader->header().obstacle_names.size());
    std::uint64_t touched = 0;
    const auto replayed = session::replay(*reader, std::move(*at), [&](const session::ReplayTick& moment) {
        touched += moment.output.touched.is_none() ? 0U : 1U;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->ticks == reader->tick_count());
    CHECK(replayed->ticks > 50'000);
    CHECK(touched > 200);
    CHECK(replayed->mismatches == 0);
    std::filesystem::remove(file);
}

TEST_CASE("Contact lesson: a trainee sees that a free nut follows the ratchet, and goes on to the next one") {
    if (test::sanitized) return test::skip_rest("a lesson of minutes");
    // Here the loosened nut followed the ratchet back and forth without an end.
    auto loaded = content::load_assembly(content::assembly_folder("pump-32-160"));
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, "torque_wrench"));
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("clumsy").value();
    options.lesson.task = lesson::Task::loosen;
    options.lesson.obstacles = session::ObstacleUse::required;
    options.lesson.seed = 1001;
    const test::Folder folder;
    const auto outcome = trainees::train(loaded.assembly, options, folder / "loosened.boltwright",
                                         [](const auto&) { return true; });
    REQUIRE(outcome);
    CHECK(outcome->result.finished);
}
