// Whole lessons by simulated trainees, with what would have been said all along.

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
    static const content::Loaded loaded = content::load_assembly("cover-m8");
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

struct Told {
    int frames = 0, silent = 0, of_other_joints = 0, unfilled = 0, hasty = 0, changes = 0, mistakes = 0;
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

int unfilled(const std::string& said) { return said.empty() || said.find('{') != std::string::npos ? 1 : 0; }

Told play_through(const char* trainee, std::uint64_t seed, Mode mode, Task task) {
    const content::Assembly& assembly = cover();
    const servo::Setup setup = session::make_setup(assembly, joint::Law::mechanistic, {}, seed, 1e-3);
    servo::State state = servo::initial_state(setup);
    if (task == Task::loosen) REQUIRE(session::pretighten(assembly, setup, state).has_value());
    Lesson lesson = begin(assembly, mode, task);
    trainees::Operator hand(trainees::find_profile(trainee).value(), seed, setup);
    Hints hints;
    test::HapticWorld world(state.joints.size());
    Mistakes mistakes;
    Told told;
    bool wrench = false;
    std::optional<Situation> said;
    std::size_t step = 0;
    double stood = 1e9;
    while (lesson.due() != nullptr && state.tick < 1'800'000) {
        const servo::Input input = hand.act(setup, state, lesson);
        const servo::Output output = servo::tick(setup, state, input);
        observe(lesson, state, output);
        if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
        for (const Event& event : lesson.events) note(mistakes, lesson, event);
        lesson.events.clear();
        if (state.tick % frame_ticks != 0) continue;
        const Scene scene{lesson, setup, world.write(state.joints, state.rounded, output, wrench)};
        const std::optional<Hint>& hint = update(hints, scene, frame_time);
        ++told.frames;
        if (const auto& mistake = update(mistakes, frame_time)) {
            ++told.mistakes;
            for (const words::Words& words : languages())
                told.unfilled +=
                    unfilled(say_why(words, *mistake)) + unfilled(say_what_to_do(words, *mistake));
        }
        stood += frame_time;
        if (!hint) {
            ++told.silent;
            continue;
        }
        const Step* due = lesson.due();
        told.of_other_joints += hint->joint != (due == nullptr ? -1 : static_cast<int>(due->joint)) ? 1 : 0;
        told.situations.insert(hint->situation);
        for (const words::Words& words : languages()) told.unfilled += unfilled(say(words, *hint));
        if (said && *said != hint->situation) {
            ++told.changes;
            if (step == lesson.current && !urgent(hint->situation) &&
                stood < (at_work(hint->situation) ? shortest_when_past : shortest_hint) - 1e-9)
                ++told.hasty;
            stood = 0.0;
        }
        said = hint->situation;
        step = lesson.current;
    }
    told.finished = lesson.due() == nullptr;
    return told;
}

}  // namespace

TEST_CASE("Hints: guided: from the first tick to the last somebody is told what to do about the due joint") {
    std::set<Situation> seen;
    int mistakes = 0;
    for (const Task task : {Task::tighten, Task::loosen})
        for (const char* trainee : {"expert", "novice", "clumsy"})
            for (const std::uint64_t seed : {1U, 2U, 3U}) {
                CAPTURE(std::string(trainee));
                CAPTURE(seed);
                CAPTURE(static_cast<int>(task));
                const Told told = play_through(trainee, seed, Mode::guided, task);
                CHECK(told.finished);
                CHECK(told.frames > 500);
                CHECK(told.silent == 0);
                CHECK(told.of_other_joints == 0);
                CHECK(told.unfilled == 0);
                CHECK(told.hasty == 0);
                CHECK(told.changes > 10);
                seen.insert(told.situations.begin(), told.situations.end());
                mistakes += told.mistakes;
            }
    CHECK(mistakes > 0);
    // What a lesson that goes well is made of was all said.
    for (const Situation s :
         {Situation::round_run_down, Situation::round_tighten, Situation::round_recheck,
          Situation::round_loosen, Situation::next, Situation::run_down, Situation::take_wrench,
          Situation::pull, Situation::ease, Situation::stop, Situation::check, Situation::checked,
          Situation::turn_off, Situation::wrong_joint, Situation::all_done}) {
        CAPTURE(static_cast<int>(s));
        CHECK(seen.contains(s));
    }
}

TEST_CASE("Hints: assessment: not a word; practice: only to who gets nowhere") {
    for (const char* trainee : {"novice", "clumsy"}) {
        const Told examined = play_through(trainee, 1, Mode::assessment, Task::tighten);
        CHECK(examined.finished);
        CHECK(examined.silent == examined.frames);
        CHECK(examined.mistakes == 0);
        const Told practised = play_through(trainee, 1, Mode::practice, Task::tighten);
        CHECK(practised.finished);
        CHECK(practised.silent > practised.frames * 9 / 10);
    }
}
