// Lessons whose bolt heads only a second wrench holds.
#include <doctest/doctest.h>

#include <algorithm>

#include "game/lesson/hints.hpp"
#include "game/lesson/judge.hpp"
#include "game/motion/path_planning.hpp"
#include "tests/lesson/played_session.hpp"
#include "tests/support/second_wrench.hpp"

namespace bolt::lesson::counter_hold {

namespace {

content::Assembly load(const std::filesystem::path& file) {
    content::LoadedAssembly loaded = content::load_assembly(file.parent_path().string());
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    return std::move(loaded.assembly);
}

struct Played {
    test::PlayedSession session;
    double common_turn = 0.0;  // rad, largest
    bool held = false;         // a second wrench was used
};

Played play(const content::Assembly& assembly, const char* profile, const session::LessonOptions& options) {
    Played played;
    const test::ReplaySetup own_setup = [](const session::SessionReader& r) {
        return session::restore_setup(r);
    };
    played.session =
        test::play_and_replay(assembly, options, profile, own_setup, [&](const session::ReplayTick& tick) {
            played.common_turn = std::max(played.common_turn, std::abs(tick.state.joints[0].common_turn));
            played.held = played.held || tick.input.second_wrench == 0;
        });
    return played;
}

int deductions(const LessonResult& result, DeductionKind kind) {
    return static_cast<int>(std::count_if(result.reasons.begin(), result.reasons.end(),
                                          [&](const Deduction& d) { return d.kind == kind; }));
}

// A wrench on the nut of a joint that is run down, turned step by step.
struct Pull {
    const test::Folder folder;
    content::Assembly assembly;
    session::SessionSetup at;
    Lesson lesson;
    world::World world;
    servo::TickInput input;
    double turned = 0.0;  // rad

    explicit Pull(double friction, Task task = Task::tighten)
        : assembly(load(test::lesson_with_second_wrench(folder, friction))),
          at(session::prepare_session(assembly, {}).value()) {
        joint::JointState& nut = at.state.joints[0];
        while (nut.clamp < 1000.0)
            joint::turn_nut(at.setup.group, at.state.joints, 0, nut.nut.angle + 1e-4, 1.0, 1e-3);
        nut.nut.speed = 0.0;
        lesson = begin(assembly, Mode::practice, task);
        lesson.current = lesson.steps.size() - 1;
        world::add_haptics(world, at.state);
        input.dead_man = true;
        input.grip = servo::Grip::wrench;
        start_ = nut.rotation();
    }
    // Turns the wrench by `degrees` at 60°/s.
    void turn(double degrees) {
        const int ticks = static_cast<int>(std::abs(degrees) / 0.06);
        for (int i = 0; i < ticks; ++i) {
            turned += std::copysign(to_radians(0.06), degrees);
            const servo::NutGeometry& nut = at.setup.nuts[0];
            const double fits = start_ + nut.sense * at.setup.wrench.head_angle + turned;
            input.commanded_tool =
                servo::to_commanded_tool({servo::nut_centre(nut, at.state.joints[0].nut.angle),
                                          motion::tool_orientation(nut, fits, false)});
            const servo::Output output = servo::tick(at.setup, at.state, input);
            world::write_haptics(world, {at.state, input, output});
            observe(lesson, world);
        }
    }
    [[nodiscard]] const joint::JointState& joint() const { return at.state.joints[0]; }
    [[nodiscard]] int reported() const {
        return static_cast<int>(std::count_if(
            lesson.events.begin(), lesson.events.end(),
            [](const LessonEvent& event) { return event.mistake == MistakeKind::turned_together; }));
    }
    [[nodiscard]] Situation now() const { return situation({lesson, at.setup, world}); }

  private:
    double start_ = 0.0;
};

}  // namespace

TEST_CASE("Counter-hold: a bolt that turns with its nut gives a hint, and one mistake per hold") {
    Pull pull(0.12);
    pull.turn(5.0);
    CHECK(pull.now() == Situation::counter_hold);
    CHECK(pull.reported() == 0);
    pull.turn(55.0);
    CHECK(pull.reported() == 1);
    CHECK(pull.lesson.joints[0].peak_torque == 0.0);  // such a pull does not count for the step
    CHECK(pull.joint().clamp < 1100.0);
    CHECK(to_degrees(pull.joint().common_turn) > 40.0);
    // The wrench stays on the nut, which has turned with the bolt.
    CHECK(pull.lesson.held_joint == 0);
    CHECK(judge(pull.lesson, pull.world, 1e-3).score < 100.0);

    pull.input.second_wrench = 0;
    const double turned = pull.joint().common_turn;
    pull.turn(40.0);
    CHECK(pull.joint().clamp > 5000.0);
    CHECK(pull.joint().common_turn == turned);
    CHECK(pull.now() != Situation::counter_hold);
    CHECK(pull.reported() == 1);
}

TEST_CASE("Counter-hold: dry threads and faces hold the head by friction alone") {
    Pull pull(0.3);
    pull.turn(40.0);
    CHECK(pull.joint().clamp > 5000.0);
    CHECK(pull.reported() == 0);
}

TEST_CASE("Counter-hold: a second wrench on another joint holds nothing") {
    Pull pull(0.12);
    pull.input.second_wrench = 1;
    pull.turn(60.0);
    CHECK(pull.reported() == 1);
}

TEST_CASE("Counter-hold: a wrench finds the nut where the bolt has turned it") {
    Pull pull(0.12);
    pull.turn(47.0);
    const double rotation = pull.joint().rotation();
    pull.input.grip = servo::Grip::none;
    pull.turn(-0.6);  // so that the jaw is within its play
    REQUIRE(pull.at.state.engagement.joint == -1);
    // The hexagon has turned by 47° less the play: by a corner that is not where it was.
    const force::GuideTarget target = servo::guide_target(pull.at.setup, pull.at.state.joints, 0);
    const servo::NutGeometry& nut = pull.at.setup.nuts[0];
    const double flat = servo::angle_of(nut, target.hexagon.flat);
    CHECK(std::remainder(flat - rotation, pi / 3.0) == doctest::Approx(0.0).epsilon(1e-9));
    pull.input.grip = servo::Grip::wrench;
    pull.turn(0.06);
    CHECK(pull.at.state.engagement.joint == 0);
}

TEST_CASE("Counter-hold: every trainee finishes both tasks, and the session replays to the same bits") {
    const test::Folder folder;
    const content::Assembly assembly = load(test::lesson_with_second_wrench(folder));
    int forgotten = 0;
    for (const Task task : {Task::tighten, Task::loosen})
        for (const char* profile : {"expert", "novice", "clumsy"})
            for (std::uint64_t seed = 1; seed <= 8; ++seed) {
                CAPTURE(profile);
                CAPTURE(seed);
                session::LessonOptions options;
                options.seed = seed;
                options.task = task;
                const Played played = play(assembly, profile, options);
                CHECK(played.session.result.finished);
                CHECK(played.session.mismatches == 0);
                CHECK(played.held);
                const int common_turns = deductions(played.session.result, DeductionKind::turned_together);
                if (profile == std::string_view("expert")) CHECK(common_turns == 0);
                if (common_turns > 0) CHECK(to_degrees(played.common_turn) > 10.0);
                forgotten += common_turns;
            }
    CHECK(forgotten > 0);
}

TEST_CASE("Counter-hold: a trainee notices a bolt that a ratchet only turns to and fro") {
    // The parts beside B10 leave the ratchet a swing of about 30°.
    content::LoadedAssembly loaded =
        content::load_assembly(content::assembly_folder("dn200-pn16").string(), "held_heads");
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, "ratchet"));
    const auto& joints = loaded.assembly.joints;
    const auto joint =
        std::find_if(joints.begin(), joints.end(),
                     [](const content::AssemblyJoint& candidate) { return candidate.design.id == "B10"; });
    REQUIRE(joint != joints.end());
    content::Pass only;
    only.kind = content::PassKind::loosen;
    only.order = {static_cast<std::size_t>(joint - joints.begin())};
    loaded.assembly.loosening = {only};
    trainees::TrainOptions train;
    train.lesson.task = Task::loosen;
    train.lesson.obstacles = session::ObstacleUse::required;
    train.trainee = trainees::find_profile("novice").value();
    train.trainee.forgets_second_wrench = 1.0;
    const test::Folder folder;
    const auto outcome = trainees::train(loaded.assembly, train, folder / "lesson.boltwright",
                                         [](const trainees::TrainingProgress&) { return true; });
    REQUIRE(outcome);
    CHECK(outcome->result.finished);
    CHECK(deductions(outcome->result, DeductionKind::turned_together) > 0);
}

}  // namespace bolt::lesson::counter_hold
