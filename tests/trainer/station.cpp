// A lesson at a station in virtual time: the lesson repeats the station's ticks with its own servo, and a
// simulated trainee plays by keyboard.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "content/format/assembly.hpp"
#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainer/helped_hand.hpp"
#include "game/trainer/station_client.hpp"
#include "game/trainer/step_undo.hpp"
#include "tests/station/virtual_time_station.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"

using namespace bolt;
using namespace bolt::trainer;
using platform::Key;

namespace {

namespace fs = std::filesystem;

constexpr double frame_time = 0.02;  // s

// The means by which the hand closes.
enum class Closes { by_space_bar, in_glove, by_gripper };

// The station and the lesson that repeats its ticks.
struct StationLesson {
    content::Assembly assembly;
    session::LessonOptions options;
    std::unique_ptr<session::LessonSession> session;
    world::World world;
    StationClient client;
    test::VirtualTimeStation* bench = nullptr;
    UserActions actions;
    StepUndo undo;
    std::set<Key> down;
    fs::path file;
    Status status;
    std::vector<std::string> mistakes;

    explicit StationLesson(const std::string& name, lesson::Mode mode = lesson::Mode::guided,
                           Closes closes = Closes::by_space_bar) {
        content::LoadedAssembly loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        assembly = std::move(loaded.assembly);
        options.mode = mode;
        options.obstacles = session::ObstacleUse::if_any;
        file = fs::path(BOLT_TRAINER_OUT) / "station.boltwright";
        auto one = session::prepare_session(assembly, options),
             other = session::prepare_session(assembly, options);
        REQUIRE(one);
        REQUIRE(other);
        auto made = std::make_unique<test::VirtualTimeStation>(std::move(*one), options);
        bench = made.get();
        client.link = std::move(made);
        if (closes == Closes::by_gripper) bench->add_gripper();
        if (closes == Closes::in_glove) {
            station::DisplayedHand hand;
            hand.has_angles = true;
            bench->wear(hand, Pose{Vec3(0.12, 0.02, -0.03), rotation(Vec3(0.1, 0.2, 1.5))});
            client.empty_hand_wrist = Pose{Vec3(0.02, 0.1, 0.05), rotation(Vec3(-1.0, 0.2, 0.3))};
            pinch(false);
        }

        options.device_limits = bench->setup().limits;
        session::set_device_limits(options, *other);
        auto begun = session::LessonSession::begin(std::move(*other), options, file);
        REQUIRE(begun);
        session = std::move(*begun);
        world::add_haptics(world, session->state());
        client.rest = {Vec3(0.0, 0.01, 0.25), glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
        client.home = make_hand(client.rest).pose;
        next_frame();
    }

    void hold(const std::set<Key>& keys) {
        std::vector<platform::InputEvent> events;
        for (const Key key : down)
            if (!keys.contains(key)) events.emplace_back(platform::KeyEvent{key, false, false, {}});
        for (const Key key : keys)
            if (!down.contains(key)) events.emplace_back(platform::KeyEvent{key, true, false, {}});
        down = keys;
        client.keyboard.handle_events(events);
    }
    // Sets thumb and index finger of the gloved hand together or apart.
    void pinch(bool together) const {
        bench->hand_->finger_joints.position[hand::thumb_tip] = Vec3(0.0);
        bench->hand_->finger_joints.position[hand::index_tip] = Vec3(together ? 0.02 : 0.09, 0.0, 0.0);
    }
    void next_frame() {
        bench->advance(frame_time);
        for (station::StationTick tick;
             status && continues(undo, *session) && client.link->next_tick(tick);) {
            status = session->repeat(world, tick.input, tick.output);
            for (const lesson::LessonEvent& event : session->events()) {
                if (event.kind == lesson::EventKind::mistake) mistakes.push_back(event.text);
                observe(undo, session->lesson(), event);
            }
        }
        UserActions now = actions;
        now.paused = now.paused || !continues(undo, *session);
        now.undo = steps_to_undo(undo, session->lesson());
        const Status sent = send_actions(client, *session, now);
        CHECK(sent);
        actions.toggle_wrench = actions.recentre = false;
    }
    void frames(double seconds) {
        for (double t = 0.0; t < seconds; t += frame_time) next_frame();
    }
    [[nodiscard]] const lesson::LessonStep* due() const { return session->lesson().due(); }
    [[nodiscard]] int engaged() const { return client.latest.output.joint; }
    [[nodiscard]] bool has_wrench() const { return client.latest.input.grip == servo::Grip::wrench; }
    [[nodiscard]] Vec3 nut() const {
        return servo::nut_centre(session->setup().nuts[due()->joint],
                                 session->state().joints[due()->joint].nut.angle);
    }
};

// Plays a lesson by keyboard, with or without a glove.
class KeyboardTrainee {
  public:
    explicit KeyboardTrainee(StationLesson& lesson_run) : lesson_(lesson_run) {}
    double torque_share = 1.0;  // of the due torque

    void play(double longest, std::size_t steps = SIZE_MAX) {
        while (lesson_.status && lesson_.due() != nullptr && lesson_.session->time() < longest &&
               lesson_.session->lesson().current < steps)
            do_step();
        lesson_.hold({});
    }

  private:
    // Holds keys for a frame. A gloved hand pinches instead of pressing the space bar, except with the wrench
    // in the hand, where the space bar lets a nut attract the wrench. A gripper closes instead, and stays
    // closed on the wrench.
    void hold_for_frame(std::set<Key> keys) {
        if (lesson_.client.gloved && !lesson_.has_wrench()) lesson_.pinch(keys.erase(Key::space) > 0);
        if (with_gripper()) lesson_.bench->gripper_ = keys.erase(Key::space) > 0 || holds_wrench_ ? 0.1 : 1.0;

        lesson_.hold(keys);
        lesson_.next_frame();
    }
    // Keys that move the tool along `offset`.
    static std::set<Key> towards(const Vec3& offset, double tolerance) {
        std::set<Key> keys;
        const auto add = [&](double along, Key more, Key less) {
            if (std::abs(along) > tolerance) keys.insert(along > 0.0 ? more : less);
        };
        add(offset.x, Key::d, Key::a);
        add(offset.y, Key::e, Key::q);
        add(offset.z, Key::s, Key::w);
        return keys;
    }
    void go_to(const Vec3& position, double tolerance, double longest) {
        for (double t = 0.0;
             t < longest &&
             glm::length(position - lesson_.client.latest.commanded_tool.position) > 2.0 * tolerance;
             t += frame_time)
            hold_for_frame(towards(position - lesson_.client.latest.commanded_tool.position, tolerance));
        hold_for_frame({});
    }
    void do_step() {
        const std::size_t current = lesson_.session->lesson().current;
        const bool fingers = lesson_.due()->kind == lesson::StepKind::run_down;
        if (fingers && lesson_.has_wrench()) lay_down();

        if (!fingers && !lesson_.has_wrench()) take_wrench();
        lesson_.frames(0.1);
        reach(fingers);
        if (lesson_.engaged() >= 0) {
            if (fingers)
                spin(current);
            else
                pull();
        }
        lift_off();
    }
    [[nodiscard]] bool with_gripper() const { return lesson_.bench->layout().mover->senses_gripper; }
    void lay_down() {
        lesson_.actions.toggle_wrench = !with_gripper();
        holds_wrench_ = false;
        if (with_gripper()) hold_for_frame({});
        if (lesson_.client.gloved) lesson_.bench->hand_->held = false;
    }
    void take_wrench() {
        const Pose rest = lesson_.client.latest.resting_wrench.value_or(lesson_.client.rest);
        go_to(rest * Vec3(0.1, 0.0, 0.1), 0.02, 6.0);
        go_to(rest * Vec3(0.1, 0.0, 0.03), 0.01, 4.0);
        if (lesson_.client.gloved) lesson_.bench->hand_->held = true;
        holds_wrench_ = true;
        for (int i = 0; i < 5; ++i) hold_for_frame({Key::space});
        hold_for_frame({});
        REQUIRE(lesson_.has_wrench());

        for (int i = 0; i < 30; ++i) hold_for_frame({Key::e});
    }
    // Turns the wrench to the pose in which its handle has room.
    void turn_to_fit() {
        const Pose ghost = wrench_pose_on_nut(lesson_.client.rest, lesson_.session->setup(),
                                              lesson_.session->state(), lesson_.due()->joint, false);
        for (double t = 0.0; t < 8.0; t += frame_time) {
            const Quat& now = lesson_.client.latest.commanded_tool.orientation;
            const Vec3 left = turn_between(now, ghost.orientation);
            if (glm::length(left) < 0.08) break;
            std::set<Key> keys;
            const auto add = [&](double about, Key more, Key less) {
                if (std::abs(about) > 0.03) keys.insert(about > 0.0 ? more : less);
            };
            add(left.x, Key::down, Key::up);
            add(left.y, Key::left, Key::right);
            add(left.z, Key::page_up, Key::page_down);
            hold_for_frame(keys);
        }
        hold_for_frame({});
    }
    void reach(bool fingers) {
        if (!fingers) turn_to_fit();
        go_to(lesson_.nut() + Vec3(0.0, 0.1, 0.0), 0.02, 8.0);
        for (double t = 0.0; t < 6.0 && lesson_.engaged() < 0; t += frame_time) hold_for_frame({Key::space});
    }
    void spin(std::size_t current) {
        for (double t = 0.0;
             t < 60.0 && lesson_.session->lesson().current == current && lesson_.engaged() >= 0 &&
             !lesson::step_fulfilled(lesson_.session->lesson(), lesson_.world);
             t += frame_time)
            hold_for_frame({Key::space, Key::right});
    }
    void pull() {
        const lesson::LessonStep step = *lesson_.due();
        double still = 0.0, peak = 0.0;
        while (lesson_.status && lesson_.engaged() >= 0 && still < 1.0 &&
               lesson_.session->state().joints[step.joint].torque < torque_share * step.torque) {
            hold_for_frame({Key::right});
            const double now = lesson_.session->state().joints[step.joint].torque;
            still = now > peak + 0.02 || lesson_.session->state().joints[step.joint].nut.speed > 0.02
                        ? 0.0
                        : still + frame_time;
            peak = std::max(peak, now);
        }
        for (int i = 0;
             i < 100 && lesson_.engaged() >= 0 && lesson_.session->state().joints[step.joint].torque > 0.5;
             ++i)
            hold_for_frame({Key::left});
    }
    void lift_off() {
        for (int i = 0; i < 30; ++i) hold_for_frame({Key::e});
    }

    StationLesson& lesson_;
    bool holds_wrench_ = false;
};

// The session file replays bit for bit and ends at the same step.
void expect_replay(const StationLesson& lesson_run) {
    const auto reader = session::SessionReader::open(lesson_run.file);
    REQUIRE(reader);
    auto setup = session::restore_setup(*reader);
    REQUIRE(setup);
    std::size_t current = SIZE_MAX;
    const auto replayed = session::replay(*reader, std::move(*setup), [&](const session::ReplayTick& moment) {
        current = moment.lesson.current;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->mismatches == 0);
    CHECK(current == lesson_run.session->lesson().current);
}

}  // namespace

TEST_CASE("Station client: a lesson is played by keyboard at a station with its own servo") {
    StationLesson lesson_run("cover-m8");
    KeyboardTrainee trainee(lesson_run);
    trainee.play(test::sanitized ? 60.0 : 400.0, test::sanitized ? 1 : SIZE_MAX);
    if (!lesson_run.status) FAIL(lesson_run.status.error().message());
    MESSAGE("at " << lesson_run.session->time() << " s step " << lesson_run.session->lesson().current
                  << " of " << lesson_run.session->lesson().steps.size());
    for (const std::string& mistake : lesson_run.mistakes) MESSAGE(mistake);
    const auto finished = lesson_run.session->finish(lesson_run.world);
    REQUIRE(finished);
    if (test::sanitized)
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    CHECK(finished->result.finished);
    CHECK(finished->result.score > 80.0);
    MESSAGE("score " << finished->result.score);
    expect_replay(lesson_run);
}

TEST_CASE("Station client: a gloved hand pinches and spins nuts, takes the wrench and releases it") {
    StationLesson lesson_run("cover-m8", lesson::Mode::guided, Closes::in_glove);
    REQUIRE(lesson_run.client.gloved);
    KeyboardTrainee trainee(lesson_run);
    trainee.play(test::sanitized ? 60.0 : 400.0, test::sanitized ? 1 : SIZE_MAX);
    if (!lesson_run.status) FAIL(lesson_run.status.error().message());
    MESSAGE("at " << lesson_run.session->time() << " s step " << lesson_run.session->lesson().current
                  << " of " << lesson_run.session->lesson().steps.size());
    const auto finished = lesson_run.session->finish(lesson_run.world);
    REQUIRE(finished);
    CHECK(lesson_run.session->lesson().current >= 1);
    if (test::sanitized)
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    CHECK(finished->result.finished);
    CHECK(finished->result.score > 80.0);
}

TEST_CASE("Station client: a gripper takes the wrench by closing and releases it by opening") {
    StationLesson lesson_run("cover-m8", lesson::Mode::guided, Closes::by_gripper);
    KeyboardTrainee trainee(lesson_run);
    trainee.play(test::sanitized ? 60.0 : 400.0, test::sanitized ? 1 : SIZE_MAX);
    if (!lesson_run.status) FAIL(lesson_run.status.error().message());
    const auto finished = lesson_run.session->finish(lesson_run.world);
    REQUIRE(finished);
    CHECK(lesson_run.session->lesson().current >= 1);
    if (test::sanitized)
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    CHECK(finished->result.finished);
    CHECK(finished->result.score > 80.0);
    // The fingers on the screen follow the gripper.
    lesson_run.bench->gripper_ = 0.75;
    lesson_run.frames(0.2);
    CHECK(hand_of(lesson_run.client).closed_share == 0.25);
}

TEST_CASE("Station client: a difference between the station's and the lesson's servo is an error at once") {
    StationLesson lesson_run("cover-m8");
    lesson_run.frames(0.2);
    REQUIRE(lesson_run.status);
    const double before = lesson_run.session->time();
    CHECK(before > 0.15);
    lesson_run.bench->corrupts_next_record_ = true;
    lesson_run.hold({Key::d});
    lesson_run.frames(0.1);
    CHECK_FALSE(lesson_run.status);
    CHECK(lesson_run.session->time() < before + 0.1);
}

TEST_CASE("Station client: a pause stops the lesson, and undo works as with the mouse") {
    StationLesson lesson_run("cover-m8");
    KeyboardTrainee trainee(lesson_run);
    trainee.play(60.0, 1);
    REQUIRE(lesson_run.session->lesson().current == 1);
    const std::size_t first = lesson_run.session->lesson().steps[0].joint;
    REQUIRE(lesson_run.session->state().joints[first].nut.angle > 6.0);
    lesson_run.actions.paused = true;
    lesson_run.frames(0.1);
    const double before = lesson_run.session->time();
    lesson_run.hold({Key::d});
    lesson_run.frames(1.0);
    CHECK(lesson_run.session->time() == before);
    lesson_run.actions.paused = false;
    lesson_run.hold({});
    request_undo(lesson_run.undo, lesson_run.session->lesson(), 1);
    lesson_run.frames(0.5);
    CHECK_FALSE(lesson_run.undo.target);
    CHECK(lesson_run.session->lesson().current == 0);
    CHECK(lesson_run.session->state().joints[first].nut.angle == 0.0);
    lesson_run.frames(0.2);
    REQUIRE(lesson_run.status);
    REQUIRE(lesson_run.session->finish(lesson_run.world));
    expect_replay(lesson_run);
}

TEST_CASE("Station client: a mistake in the last step restarts that step before the lesson ends") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8");
    StationLesson lesson_run(one.name());
    KeyboardTrainee trainee(lesson_run);
    trainee.play(60.0, 1);
    REQUIRE(lesson_run.session->lesson().current == 1);
    REQUIRE(lesson_run.session->lesson().steps.size() == 2);
    const joint::JointState& joint = lesson_run.session->state().joints[0];
    const double seated = joint.nut.angle;
    trainee.torque_share = 1.3;
    for (int i = 0; i < 60 && lesson_run.mistakes.empty(); ++i)
        trainee.play(lesson_run.session->time() + 1.0, 2);
    REQUIRE(lesson_run.mistakes.size() == 1);
    for (int i = 0; i < 100 && joint.nut.angle > seated; ++i) lesson_run.next_frame();
    CHECK(joint.nut.angle == seated);
    CHECK(lesson_run.session->lesson().current == 1);
    CHECK_FALSE(lesson_run.undo.target);
    REQUIRE(continues(lesson_run.undo, *lesson_run.session));

    trainee.torque_share = 1.0;
    trainee.play(200.0);
    CHECK_FALSE(continues(lesson_run.undo, *lesson_run.session));
    if (!lesson_run.status) FAIL(lesson_run.status.error().message());
    const auto finished = lesson_run.session->finish(lesson_run.world);
    REQUIRE(finished);
    CHECK(finished->result.finished);
    CHECK(finished->result.joints[0].overall == lesson::Verdict::ok);
    CHECK(lesson_run.mistakes.size() == 1);
    expect_replay(lesson_run);
}

TEST_CASE("Station client: only a gloved hand has a limited twist") {
    StationClient client;
    client.gloved = true;
    client.latest.output.joint = 0;
    client.latest.input.grip = servo::Grip::fingers;
    client.nut_angle_at_grip = 40.0;
    client.latest.output.nut_angle = 40.0;
    CHECK(hand_of(client).free_swing == doctest::Approx(forearm_range));
    client.latest.output.nut_angle = 40.0 + to_radians(119.0);
    CHECK(hand_of(client).free_swing == doctest::Approx(to_radians(1.0)));
    client.latest.output.nut_angle = 40.0 - to_radians(150.0);
    CHECK(hand_of(client).free_swing == 0.0);
    client.latest.input.grip = servo::Grip::wrench;
    CHECK(std::isinf(hand_of(client).free_swing));
    client.latest.input.grip = servo::Grip::fingers;
    client.gloved = false;
    CHECK(std::isinf(hand_of(client).free_swing));
    client.gloved = true;
    client.latest.output.joint = -1;
    CHECK(std::isinf(hand_of(client).free_swing));
}
