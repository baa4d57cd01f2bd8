// Hints and mistakes during whole lessons of simulated trainees.

#include <doctest/doctest.h>

#include <set>

#include "content/format/assembly.hpp"
#include "game/lesson/feedback.hpp"
#include "game/lesson/hints.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/hints/bench.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::at_work;

namespace {

constexpr int frame_ticks = 16;
constexpr double frame_time = 0.016;

const content::Assembly& cover() {
    static const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    return loaded.assembly;
}

const std::vector<words::Words>& languages() {
    static const std::vector<words::Words> all = [] {
        std::vector<words::Words> list;
        for (const std::string& language : words::languages(words::words_folder()))
            list.push_back(words::load_words(words::words_folder(), language).words);
        return list;
    }();
    return all;
}

struct HintLog {
    int frames = 0, without_hint = 0, of_other_joints = 0, unfilled = 0, too_short = 0, changes = 0,
        mistakes = 0;
    std::set<Situation> situations;
    bool finished = false;
};

bool urgent(Situation s) {
    for (const Situation u :
         {Situation::stop, Situation::stop_at_yield, Situation::stop_at_click, Situation::stop_too_much,
          Situation::wrong_joint, Situation::other_way_on, Situation::other_way_off, Situation::seated,
          Situation::checked, Situation::all_done, Situation::leave_broken, Situation::leave_stripped})
        if (s == u) return true;
    return false;
}

int unfilled(const std::string& text) { return text.empty() || text.find('{') != std::string::npos ? 1 : 0; }

HintLog play_through(const char* trainee, std::uint64_t seed, Mode mode, Task task) {
    const content::Assembly& assembly = cover();
    const servo::Setup setup = session::make_setup(assembly, joint::Law::mechanistic, {}, seed, 1e-3);
    servo::State state = servo::initial_state(setup);
    if (task == Task::loosen) REQUIRE(session::pretighten(assembly, setup, state).has_value());
    Lesson lesson = begin(assembly, mode, task);
    trainees::SimulatedTrainee hand(trainees::find_profile(trainee).value(), seed, setup);
    HintState hints;
    world::World components = test::make_world(state);
    test::HapticWorld world(state.joints.size());
    MistakeState mistakes;
    HintLog log;
    bool wrench = false;
    std::optional<Situation> previous;
    std::size_t step = 0;
    double shown_for = 1e9;
    while (lesson.due() != nullptr && state.tick < 1'800'000) {
        const servo::TickInput input = hand.act(setup, state, lesson);
        const servo::Output output = servo::tick(setup, state, input);
        test::observe_tick(lesson, components, state, output);
        if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
        for (const LessonEvent& event : lesson.events) add_event(mistakes, lesson, event);
        lesson.events.clear();
        if (state.tick % frame_ticks != 0) continue;
        const ObservedLesson work{lesson, setup, world.write(state, output, wrench)};
        const std::optional<Hint>& hint = update(hints, work, frame_time);
        ++log.frames;
        if (const auto& mistake = update(mistakes, frame_time)) {
            ++log.mistakes;
            for (const words::Words& words : languages())
                log.unfilled +=
                    unfilled(mistake_text(words, *mistake)) + unfilled(remedy_text(words, *mistake));
        }
        shown_for += frame_time;
        if (!hint) {
            ++log.without_hint;
            continue;
        }
        const LessonStep* due = lesson.due();
        log.of_other_joints += hint->joint != (due == nullptr ? -1 : static_cast<int>(due->joint)) ? 1 : 0;
        log.situations.insert(hint->situation);
        for (const words::Words& words : languages()) log.unfilled += unfilled(hint_text(words, *hint));
        if (previous && *previous != hint->situation) {
            ++log.changes;
            if (step == lesson.current && !urgent(hint->situation) &&
                shown_for <
                    (at_work(hint->situation) ? min_duration_when_fulfilled : min_hint_duration) - 1e-9)
                ++log.too_short;
            shown_for = 0.0;
        }
        previous = hint->situation;
        step = lesson.current;
    }
    log.finished = lesson.due() == nullptr;
    return log;
}

}  // namespace

TEST_CASE("Hints: guided: a hint for the due joint is shown from the first tick to the last") {
    std::set<Situation> seen;
    int mistakes = 0;
    for (const Task task : {Task::tighten, Task::loosen})
        for (const char* trainee : {"expert", "novice", "clumsy"})
            for (const std::uint64_t seed : {1U, 2U, 3U}) {
                CAPTURE(std::string(trainee));
                CAPTURE(seed);
                CAPTURE(static_cast<int>(task));
                const HintLog log = play_through(trainee, seed, Mode::guided, task);
                CHECK(log.finished);
                CHECK(log.frames > 500);
                CHECK(log.without_hint == 0);
                CHECK(log.of_other_joints == 0);
                CHECK(log.unfilled == 0);
                CHECK(log.too_short == 0);
                CHECK(log.changes > 10);
                seen.insert(log.situations.begin(), log.situations.end());
                mistakes += log.mistakes;
            }
    CHECK(mistakes > 0);
    // All situations of a regular lesson had a hint.
    for (const Situation s :
         {Situation::pass_run_down, Situation::pass_tighten, Situation::pass_recheck, Situation::pass_loosen,
          Situation::next, Situation::run_down, Situation::take_wrench, Situation::pull, Situation::ease,
          Situation::stop, Situation::check, Situation::checked, Situation::unscrew, Situation::wrong_joint,
          Situation::all_done}) {
        CAPTURE(static_cast<int>(s));
        CHECK(seen.contains(s));
    }
}

TEST_CASE("Hints: none in assessment, few in practice") {
    for (const char* trainee : {"novice", "clumsy"}) {
        const HintLog examined = play_through(trainee, 1, Mode::assessment, Task::tighten);
        CHECK(examined.finished);
        CHECK(examined.without_hint == examined.frames);
        CHECK(examined.mistakes == 0);
        const HintLog practised = play_through(trainee, 1, Mode::practice, Task::tighten);
        CHECK(practised.finished);
        CHECK(practised.without_hint > practised.frames * 9 / 10);
    }
}
