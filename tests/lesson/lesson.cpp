#include "game/lesson/lesson.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string_view>
#include <utility>

#include "content/format/assembly.hpp"
#include "game/lesson/judge.hpp"
#include "game/lesson/law.hpp"
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
    content::Assembly assembly = zq350();
    assembly.joints[5].published.targets->torque.target = 72.05;  // a joint may differ from the others
    const content::Assembly published = apply_law(assembly, joint::Law::published);
    CHECK(published.law == joint::Law::published);
    for (const content::AssemblyJoint& joint : published.joints) {
        const content::Specification& own = *joint.published.targets;
        CHECK(joint.spec.torque.target == (joint.design.id == "B6" ? 72.05 : 72.1));
        CHECK(joint.spec.torque.low == own.torque.low);
        CHECK(joint.spec.snug_torque == own.snug_torque);
        REQUIRE(joint.spec.has_angle);
        CHECK(joint.spec.angle.high == own.angle.high);
        CHECK(joint.spec.risk == content::RiskClass::B);  // of the joint type
    }
    for (const LessonStep& step : make_plan(published, Task::tighten))
        if (step.kind == StepKind::tighten && step.joint != 5)
            CHECK(step.torque == doctest::Approx(72.1 * step.fraction));
    CHECK(apply_law(assembly, joint::Law::mechanistic).joints[0].spec.torque.target == 78.0);
}

TEST_CASE("Plan: without own targets those of the published law lie in the last third of the yield stage") {
    for (const double specified : {20.0, 78.0, 200.0}) {
        content::Assembly assembly = zq350();
        for (content::AssemblyJoint& joint : assembly.joints) {
            joint.published.targets.reset();
            joint.spec.torque = {specified, 0.9 * specified, 1.1 * specified};
        }
        for (const content::AssemblyJoint& joint : apply_law(assembly, joint::Law::published).joints) {
            const content::Specification& spec = joint.spec;
            const joint::PublishedParameters& law = joint.published.law;
            CHECK(spec.torque.target == doctest::Approx(72.126 - 0.0015 * square(9.0)).epsilon(1e-9));
            CHECK(spec.torque.low == doctest::Approx(72.126 - 0.0015 * square(30.0)).epsilon(1e-9));
            CHECK(spec.torque.high > law.T_max_Nm);
            CHECK(spec.snug_torque < spec.torque.low);
            REQUIRE(spec.has_angle);
            CHECK(spec.angle.low < spec.angle.target);
            const double end = law.theta_max_deg - joint::published_angle(law, spec.snug_torque);
            CHECK(to_degrees(spec.angle.high) == doctest::Approx(end + 30.0));
        }
        CHECK(apply_law(assembly, joint::Law::mechanistic).joints[3].spec.torque.target == specified);
    }
}

TEST_CASE("Plan: adapting an assembly to the published law twice changes no bit") {
    const content::LoadedAssembly cover = content::load_assembly("cover-m8");
    REQUIRE(cover.ok());
    for (const content::Assembly& given : {zq350(), cover.assembly})
        for (const content::Tool& tool : given.tools) {
            content::Assembly assembly = given;
            REQUIRE(content::choose_tool(assembly, tool.name).has_value());
            const content::Assembly once = apply_law(assembly, joint::Law::published);
            const content::Assembly twice = apply_law(once, joint::Law::published);
            for (std::size_t i = 0; i < once.joints.size(); ++i) {
                const content::Specification &a = once.joints[i].spec, &b = twice.joints[i].spec;
                CHECK(a.torque.target == b.torque.target);
                CHECK(a.torque.low == b.torque.low);
                CHECK(a.angle.low == b.angle.low);
                CHECK(a.angle.high == b.angle.high);
                CHECK(once.joints[i].published.law.theta_max_deg ==
                      twice.joints[i].published.law.theta_max_deg);
            }
        }
}

TEST_CASE("Plan: under the published law a nut starts on its thread unless the file gives theta_max") {
    const auto gap = [](const content::Assembly& assembly, std::size_t joint) {
        return session::make_setup(assembly, joint::Law::published, {}, 1, 1e-3).nuts[joint].start_gap;
    };
    content::Assembly assembly = zq350();
    const content::Assembly adapted = apply_law(assembly, joint::Law::published);
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const joint::JointDesign& design = assembly.joints[i].design;
        CHECK(gap(adapted, i) == doctest::Approx(design.start_gap).epsilon(1e-9));
        CHECK(gap(adapted, i) < design.bolt_length - design.grip_length());
    }
    assembly.joints[0].published.has_theta_max = true;
    CHECK(gap(apply_law(assembly, joint::Law::published), 0) == doctest::Approx(0.0396).epsilon(0.01));
    assembly = zq350();
    assembly.joints[0].design.start_gap = 0.0;  // the transition is still ahead of the nut
    const joint::PublishedParameters law = apply_law(assembly, joint::Law::published).joints[0].published.law;
    CHECK(joint::published_boundaries(law).transition > 60.0);
}

TEST_CASE("Plan: a torque wrench clicks before the end of the published law, whatever its deviation") {
    content::Assembly assembly = zq350();
    REQUIRE(content::choose_tool(assembly, "torque_wrench").has_value());
    for (const bool own : {true, false}) {
        if (!own)
            for (content::AssemblyJoint& joint : assembly.joints) joint.published.targets.reset();
        for (const content::AssemblyJoint& joint : apply_law(assembly, joint::Law::published).joints) {
            const joint::PublishedParameters& law = joint.published.law;
            const content::Specification& spec = joint.spec;
            const double accuracy = assembly.wrench.click_accuracy;
            CHECK(spec.torque.target * (1.0 + accuracy) < law.T_max_Nm);
            // Every click is in the yield stage and in both windows.
            const double least = spec.torque.target * (1.0 - accuracy);
            CHECK(least > joint::published_yield_torque(law, law.theta_max_deg - law.yield_width_deg));
            CHECK(spec.torque.low <= least);
            CHECK(to_degrees(spec.angle.low) <=
                  joint::published_angle(law, least) - joint::published_angle(law, spec.snug_torque));
        }
    }
}

TEST_CASE("Plan: sessions before format 6 keep their targets under the published law") {
    content::Assembly assembly = zq350();
    const auto old = [&] {
        return apply_law(assembly, joint::Law::published, LawAdaptation::before_format_6).joints[0];
    };
    CHECK(old().spec.torque.target == 72.1);
    CHECK_FALSE(old().spec.has_angle);
    CHECK(old().published.law.theta_max_deg == 7218.0);
    assembly.joints[0].published.targets.reset();
    CHECK(old().spec.torque.target == 0.98 * 72.126);
    CHECK(old().spec.torque.low == 60.0);
    CHECK(old().spec.torque.high == 98.0);
    CHECK(old().spec.strategy == content::Strategy::torque);
}

TEST_CASE("Lesson: under the published law every trainee tightens every joint into the yield stage") {
    for (const char* variant : {"carbon_steel", "stainless"}) {
        const content::LoadedAssembly loaded = content::load_assembly("zq350", variant);
        REQUIRE(loaded.ok());
        for (const bool own : {true, false})
            for (const char* trainee : {"expert", "novice", "clumsy"}) {
                CAPTURE(variant);
                CAPTURE(own);
                CAPTURE(trainee);
                content::Assembly assembly = loaded.assembly;
                if (!own)
                    for (content::AssemblyJoint& joint : assembly.joints) joint.published.targets.reset();
                const LessonRun run =
                    play_through(assembly, trainee, 7, Mode::guided, Task::tighten, joint::Law::published);
                CHECK(run.result.finished);
                const bool expert = std::string_view(trainee) == "expert";
                for (std::size_t i = 0; i < run.result.joints.size(); ++i) {
                    const joint::PublishedParameters& law = assembly.joints[i].published.law;
                    const double onset = law.T_max_Nm - law.kappa1 * square(law.yield_width_deg);
                    CHECK(run.state.joints[i].published.peak_deg > 0.0);
                    CHECK(run.result.joints[i].torque > onset);
                    CHECK(run.result.joints[i].angle_verdict != Verdict::none);
                    // The expert feels the end of the curve.
                    if (expert) CHECK(run.result.joints[i].torque > 0.999 * law.T_max_Nm);
                    if (expert) CHECK(run.result.joints[i].overall == Verdict::ok);
                }
            }
    }
}

TEST_CASE("Lesson: turning far beyond the end of the published law is judged too much by its angle") {
    const content::Assembly assembly = apply_law(zq350(), joint::Law::published);
    const servo::Setup setup = session::make_setup(assembly, joint::Law::published, {}, 1, 1e-3);
    servo::State state = servo::initial_state(setup);
    const auto angle_at = [&](double further) {
        return to_radians(assembly.joints[0].published.law.theta_max_deg + further);
    };
    for (const auto& [further, verdict] : {std::pair{0.0, Verdict::ok}, std::pair{40.0, Verdict::high}}) {
        world::World world = test::make_world(state);
        Lesson lesson = begin(assembly, Mode::guided, Task::tighten);
        JointTrack& track = lesson.joints[0];
        joint::turn_nut(setup.group, state.joints, 0, angle_at(further), 1.0, 1e-3);
        track.turned_torque = state.joints[0].torque;
        track.result.angle =
            angle_at(further) - to_radians(joint::published_angle(assembly.joints[0].published.law, 20.0));
        test::observe_tick(lesson, world, state, {});
        const JointResult result = judge_joint(lesson, 0, world);
        CHECK(result.torque == doctest::Approx(72.126));
        CHECK(result.torque_verdict == Verdict::ok);
        CHECK(result.overall == verdict);
    }
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
