#include "game/lesson/lesson.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "content/format/assembly.hpp"
#include "game/session/export.hpp"
#include "game/session/lesson_session.hpp"
#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/haptic_world.hpp"

namespace lesson_lesson_test {

using namespace bolt;
using namespace bolt::lesson;

namespace {

const content::Assembly& zq350() {
    static const content::LoadedAssembly loaded = content::load_assembly("zq350");
    REQUIRE(loaded.ok());
    return loaded.assembly;
}

struct LessonRun {
    LessonResult result;
    std::vector<LessonEvent> events;
    std::uint64_t hash = 14695981039346656037ULL;
    servo::State state;
};

LessonRun play_through(const content::Assembly& given, const char* trainee, std::uint64_t seed,
                       Mode mode = Mode::guided, Task task = Task::tighten,
                       joint::Law law = joint::Law::mechanistic) {
    const content::Assembly assembly = apply_law(given, law);
    const servo::Setup setup = session::make_setup(assembly, law, {}, seed, 1e-3);
    LessonRun run;
    run.state = servo::initial_state(setup);
    if (task == Task::loosen) REQUIRE(session::pretighten(assembly, setup, run.state).has_value());
    world::World world = test::make_world(run.state);
    Lesson lesson = begin(assembly, mode, task);
    trainees::SimulatedTrainee hand(trainees::find_profile(trainee).value(), seed, setup);
    while (lesson.due() != nullptr && run.state.tick < 3'600'000) {
        const servo::TickInput input = hand.act(setup, run.state, lesson);
        const servo::Output output = servo::tick(setup, run.state, input);
        test::observe_tick(lesson, world, run.state, output);
        const double values[] = {output.force.x,       output.force.y,   output.force.z, output.torque.y,
                                 output.wrench_torque, output.nut_angle, output.clamp};
        const auto* bytes = reinterpret_cast<const unsigned char*>(values);
        for (std::size_t k = 0; k < sizeof values; ++k) run.hash = (run.hash ^ bytes[k]) * 1099511628211ULL;
        for (LessonEvent& event : lesson.events) run.events.push_back(std::move(event));
        lesson.events.clear();
    }
    run.result = judge(lesson, world, 1e-3);
    return run;
}

}  // namespace

TEST_CASE("Lesson: the plan has every joint in every pass, in the assembly's order") {
    const content::Assembly& assembly = zq350();
    const std::vector<LessonStep> steps = make_plan(assembly, Task::tighten);
    REQUIRE(steps.size() == assembly.passes.size() * 12);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const content::Pass& pass = assembly.passes[i / 12];
        CHECK(steps[i].joint == pass.order[i % 12]);
        CHECK(steps[i].pass == static_cast<int>(i / 12));
    }
    const std::vector<LessonStep> off = make_plan(assembly, Task::loosen);
    REQUIRE(off.size() == 12);
    CHECK(off.front().joint == assembly.passes.back().order.back());
}

TEST_CASE(
    "Lesson: for several seeds the expert tightens all twelve joints within their windows, through every "
    "stage") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const LessonRun run = play_through(zq350(), "expert", seed);
        CAPTURE(seed);
        CHECK(run.result.finished);
        CHECK(run.result.score > 90.0);
        bool felt[joint::stage_count] = {true, false, false, false};  // navigation is the initial stage
        for (const LessonEvent& event : run.events)
            if (event.kind == EventKind::stage) felt[static_cast<int>(event.value)] = true;
        for (const bool stage : felt) CHECK(stage);
        for (const JointResult& joint : run.result.joints) {
            CHECK(joint.torque_verdict == Verdict::ok);
            CHECK(joint.out_of_turn == 0);
        }
    }
}

TEST_CASE("Lesson: over several seeds, experts score above novices and novices above clumsy trainees") {
    double score[3] = {0.0, 0.0, 0.0};
    const char* names[] = {"expert", "novice", "clumsy"};
    for (int who = 0; who < 3; ++who)
        for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
            const LessonRun run = play_through(zq350(), names[who], seed);
            CHECK(run.result.finished);
            score[who] += run.result.score / 4.0;
        }
    MESSAGE("scores ", score[0], " ", score[1], " ", score[2]);
    CHECK(score[0] > score[1]);
    CHECK(score[1] > score[2]);
    CHECK(score[2] > 0.0);
}

TEST_CASE("Lesson: the same seed gives the same bits, another seed different ones") {
    CHECK(play_through(zq350(), "novice", 5).hash == play_through(zq350(), "novice", 5).hash);
    CHECK(play_through(zq350(), "novice", 5).hash != play_through(zq350(), "novice", 6).hash);
}

TEST_CASE("Lesson: every variant, law, mode and task of the reducer can be played to its end") {
    for (const char* variant : {"carbon_steel", "stainless"}) {
        const content::LoadedAssembly loaded = content::load_assembly("zq350", variant);
        REQUIRE(loaded.ok());
        for (const joint::Law law : {joint::Law::published, joint::Law::mechanistic})
            for (const Task task : {Task::tighten, Task::loosen}) {
                CAPTURE(variant);
                CAPTURE(joint::name(law));
                CAPTURE(name(task));
                const LessonRun run = play_through(loaded.assembly, "expert", 1, Mode::guided, task, law);
                CHECK(run.result.finished);
                for (const JointResult& joint : run.result.joints) CHECK(joint.torque > 30.0);
                if (task == Task::loosen)
                    for (const joint::JointState& joint : run.state.joints)
                        CHECK(joint.stage == joint::Stage::navigation);
            }
    }
    for (const Mode mode : {Mode::practice, Mode::assessment})
        CHECK(play_through(zq350(), "novice", 2, mode).result.finished);
}

TEST_CASE("Lesson: the breakaway torque of loosening is below the tightening torque") {
    const LessonRun off = play_through(zq350(), "expert", 1, Mode::guided, Task::loosen);
    for (std::size_t i = 0; i < off.result.joints.size(); ++i)
        CHECK(off.result.joints[i].torque < zq350().joints[i].spec.torque.target);
}

TEST_CASE("Lesson: events are in order: engage and release alternate, and every step begins and ends") {
    const LessonRun run = play_through(zq350(), "clumsy", 3);
    std::uint64_t tick = 0;
    int held = -1, begun = 0, ended = 0;
    for (const LessonEvent& event : run.events) {
        CHECK(event.tick >= tick);
        tick = event.tick;
        if (event.kind == EventKind::engage) {
            CHECK(held == -1);
            held = event.joint;
        } else if (event.kind == EventKind::release) {
            CHECK(held == event.joint);
            held = -1;
        } else if (event.kind == EventKind::step_begin) {
            ++begun;
        } else if (event.kind == EventKind::step_end) {
            ++ended;
        }
    }
    CHECK(begun == 60);
    CHECK(ended == 60);
}

TEST_CASE("Plan: under the published law an assembly's own targets replace those of its joint types") {
    const content::Assembly assembly = zq350();
    REQUIRE(assembly.published_targets);
    const content::Assembly published = apply_law(assembly, joint::Law::published);
    CHECK(published.law == joint::Law::published);
    for (const content::AssemblyJoint& joint : published.joints) {
        CHECK(joint.spec.torque.target == 72.1);
        CHECK(joint.spec.torque.low == assembly.published_targets->torque.low);
        CHECK(joint.spec.snug_torque == assembly.published_targets->snug_torque);
        CHECK_FALSE(joint.spec.has_angle);
    }
    for (const LessonStep& step : make_plan(published, Task::tighten))
        if (step.kind == StepKind::tighten) CHECK(step.torque == doctest::Approx(72.1 * step.fraction));
    const content::Assembly twice = apply_law(published, joint::Law::published);
    CHECK(twice.joints[0].spec.torque.target == 72.1);
    CHECK(apply_law(assembly, joint::Law::mechanistic).joints[0].spec.torque.target == 78.0);
}

TEST_CASE("Plan: without own targets no target exceeds the published law's end, and no angle is judged") {
    content::Assembly assembly = zq350();
    assembly.published_targets.reset();
    assembly.joints[3].spec.torque = {200.0, 190.0, 210.0};
    const content::Assembly published = apply_law(assembly, joint::Law::published);
    for (const content::AssemblyJoint& joint : published.joints) {
        CHECK(joint.spec.torque.target < 72.126);
        CHECK(joint.spec.torque.low < joint.spec.torque.target);
        CHECK_FALSE(joint.spec.has_angle);
    }
    CHECK(apply_law(assembly, joint::Law::mechanistic).joints[3].spec.torque.target == 200.0);
}

TEST_CASE("Lesson: a recorded lesson replays from its inputs to the same bits") {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("expert").value();
    options.lesson.seed = 9;
    const auto result =
        trainees::train(zq350(), options, file, [](const trainees::TrainingProgress&) { return true; });
    REQUIRE(result.has_value());
    const auto reader = session::SessionReader::open(file);
    REQUIRE(reader.has_value());
    CHECK(reader->complete());
    // Replay from the file: the assembly's text, the seed and the inputs.
    auto at = session::restore_setup(*reader);
    REQUIRE(at);
    const auto replayed =
        session::replay(*reader, std::move(*at), [](const session::ReplayTick&) { return true; });
    REQUIRE(replayed);
    CHECK(replayed->ticks == reader->tick_count());
    CHECK(replayed->ticks > 100'000);
    CHECK(replayed->mismatches == 0);
    // Another seed gives another friction, which the replay detects.
    auto other = session::restore_setup(*reader);
    REQUIRE(other);
    other->setup = session::make_setup(other->assembly, joint::Law::mechanistic, {},
                                       reader->header().seed + 1, reader->header().dt);
    const auto wrong = session::replay(*reader, std::move(*other),
                                       [](const session::ReplayTick& moment) { return moment.time < 60.0; });
    REQUIRE(wrong);
    CHECK(wrong->mismatches > 0);
    CHECK(wrong->first_mismatch < wrong->ticks);
    std::filesystem::remove(file);
}

TEST_CASE("Lesson: the summary has the documented fields, and the table names every joint") {
    session::LessonOutcome outcome;
    LessonResult& result = outcome.result;
    result.score = 87.5;
    for (const content::AssemblyJoint& joint : zq350().joints) {
        JointResult r;
        r.id = joint.design.id;
        r.torque = 71.25;
        r.angle = to_radians(33.5);
        r.clamp = 28123.4;
        r.overall = Verdict::ok;
        result.joints.push_back(r);
    }
    session::LessonOptions options;
    options.trainee_profile = "expert";
    const std::string json = session::summary_json(zq350(), options, outcome);
    for (const char* field :
         {"\"assembly\": \"zq350\"", "\"law\": \"mechanistic\"", "\"operator\": \"expert\"", "\"seed\": 1",
          "\"duration_s\"", "\"score\": 87.5", "\"torque_Nm\": 71.25", "\"angle_deg\": 33.5",
          "\"clamp_N\": 28123.0", "\"guide\": true", "\"obstacles\": false", "\"verdict\": \"OK\""}) {
        CAPTURE(field);
        CHECK(json.find(field) != std::string::npos);
    }
    const std::string table = session::summary_table(zq350(), result);
    for (const content::AssemblyJoint& joint : zq350().joints)
        CHECK(table.find(joint.design.id) != std::string::npos);
}

TEST_CASE("Lesson: the error for an unknown trainee suggests the nearest name") {
    const auto slip = trainees::find_profile("exprt");
    REQUIRE_FALSE(slip.has_value());
    CHECK(slip.error().expected == "did you mean expert?");
    CHECK(slip.error().code == ErrorCode::usage);
}

}  // namespace lesson_lesson_test
