// Lessons among obstacles: simulated trainees see them, reach round, bump, are guided and slide on.
#include <algorithm>
#include <string>

#include "game/lesson/lesson.hpp"
#include "game/operators/operator.hpp"
#include "tests/touch/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

struct Played {
    bool done = false;
    double seconds = 0.0;
    double step = 0.0;         // N, the greatest change of the force in a tick
    double torque_step = 0.0;  // N·m
    int slips = 0;
    double deepest = 1.0;      // m
    int bumps = 0;             // times that the wrench came to touch something with no nut in its jaw
    std::uint64_t faults = 0;  // of the watchdog
};

Played play_through(test::Workbench& bench, const char* trainee, std::uint64_t seed, lesson::Mode mode) {
    lesson::Lesson lesson = lesson::begin(bench.assembly, mode, lesson::Task::tighten);
    operators::Operator hand(operators::find_profile(trainee).value(), seed, bench.setup);
    Played played;
    Output before;
    bool touched = false;
    while (lesson.due() != nullptr && bench.state.tick < 600'000) {
        const Output output = tick(bench.setup, bench.state, hand.act(bench.setup, bench.state, lesson));
        lesson::observe(lesson, bench.state, output);
        lesson.events.clear();
        played.step = std::max(played.step, glm::length(output.force - before.force));
        played.torque_step = std::max(played.torque_step, glm::length(output.torque - before.torque));
        if (output.slipped >= 0) ++played.slips;
        if (output.contacts > 0) played.deepest = std::min(played.deepest, bench.state.touch->last.nearest);
        const bool touches =
            output.contacts > 0 && bench.state.touch->last.nearest < 0.1e-3 && output.joint < 0;
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

TEST_CASE("trainees finish a lesson among obstacles, and no tick shocks the hand") {
    for (const std::string trainee : {"expert", "clumsy"}) {
        test::Workbench bench("cover-m8");
        const Played played = play_through(bench, trainee.c_str(), 3, lesson::Mode::guided);
        MESSAGE(trainee << ": " << played.seconds << " s, " << played.bumps << " bumps, greatest step "
                        << played.step << " N and " << played.torque_step << " N m, " << played.slips
                        << " slips");
        CHECK(played.done);
        // Well below what the output stage lets through of a leap, a tenth: nothing leaps.
        CHECK(played.step < 0.05 * bench.setup.limits.force);
        CHECK(played.torque_step < 0.09 * bench.setup.limits.torque);
        CHECK(played.slips == 0);
        CHECK(played.deepest > -0.1e-3);
        CHECK(played.faults == 0);
    }
}
