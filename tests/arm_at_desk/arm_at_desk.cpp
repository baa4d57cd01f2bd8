// Plays a lesson with the device that `boltwright train --device auto` finds, in real time: the
// trainer, its threads and the driver are those of the program, the vendor's library is the emulated one,
// and a simulated trainee holds the arm. It corrects what it sees in each picture, as a person does.
//
//   BOLTWRIGHT_PLAY="VENDOR ASSEMBLY" test_arm_at_desk    VENDOR: force-dimension, open-haptics or haply
//
// It takes the minutes that a lesson takes, so without that variable it is skipped.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <thread>

#include "game/trainees/trainee.hpp"
#include "tests/arm_lesson/held_arm.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tools/emulate/arms/haply.hpp"

namespace {

using namespace bolt;
using namespace bolt::test;
namespace fs = std::filesystem;

constexpr double gain = 5.0, turn_gain = 10.0;         // 1/s, with which the hand corrects what it sees
constexpr double hand_speed = 0.25, turn_speed = 4.0;  // m/s and rad/s of the hand, at most
constexpr double used_reach = 0.85;                    // share of the arm's reach
constexpr double clutch_time = 0.7;                    // s
constexpr double longest_lesson = 900.0;               // s
constexpr std::uint32_t dead_man = 1, clutch = 2;

// Leads the emulated hand to a pose in the device's frame, every millisecond, at the speed of a hand.
class SteadyHand {
  public:
    explicit SteadyHand(const HeldArm& arm) : arm_(arm), thread_([this] { run(); }) {}
    SteadyHand(const SteadyHand&) = delete;
    SteadyHand& operator=(const SteadyHand&) = delete;
    ~SteadyHand() {
        ends_ = true;
        thread_.join();
    }
    void lead_to(const Pose& pose) {
        const std::lock_guard lock(mutex_);
        target_ = pose;
    }

  private:
    void run() {
        Pose pose;
        constexpr double dt = 1e-3;  // s
        while (!ends_) {
            Pose target;
            {
                const std::lock_guard lock(mutex_);
                target = target_;
            }
            pose.position += force::clamp_length(target.position - pose.position, hand_speed * dt);
            const Vec3 turn = turn_between(pose.orientation, target.orientation);
            pose.orientation =
                glm::normalize(rotation(force::clamp_length(turn, turn_speed * dt)) * pose.orientation);
            arm_.intend(pose);
            std::this_thread::sleep_for(std::chrono::duration<double>(dt));
        }
    }
    const HeldArm& arm_;
    std::mutex mutex_;
    Pose target_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

class Player {
  public:
    Player(HeadlessTrainer& trainer, const HeldArm& arm)
        : trainer_(trainer),
          arm_(arm),
          hand_(arm),
          trainee_(*trainees::find_profile("expert"), 1, lesson().session->setup()),
          intention_{client().home, servo::Grip::none, -1, false} {}

    // Call after each frame, `seconds` after the last one.
    void play(double seconds) {
        time_ += seconds;
        const std::uint64_t tick = lesson().session->state().tick;
        for (; tick_ < tick; ++tick_) think();
        const Goal goal = next_goal();
        arm_.press(goal.buttons | (clutching_ > 0.0 ? clutch : 0U));
        move(goal.tool, seconds);
        largest_force = std::max(largest_force, glm::length(client().latest.output.force));
    }
    void report(double now) const {
        const lesson::Lesson& current = lesson().session->lesson();
        const Vec3 at = pose_.position, tool = client().latest.commanded_tool.position,
                   to = intention_.tool.position;
        std::printf(
            "%4.0f s: step %zu of %zu, joint %d, %s%s; hand %.3f %.3f %.3f, tool %.3f %.3f %.3f, to %.3f "
            "%.3f %.3f\n",
            now, current.current, current.steps.size(), client().latest.output.joint,
            has_wrench() ? "wrench" : "empty", changes_tool_ ? ", changes" : "", at.x, at.y, at.z, tool.x,
            tool.y, tool.z, to.x, to.y, to.z);
        std::fflush(stdout);
    }
    double largest_force = 0.0;  // N
    int clutched = 0;            // times

  private:
    struct Goal {
        Pose tool;
        std::uint32_t buttons = 0;
    };
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return trainer_.lesson(); }
    [[nodiscard]] const trainer::StationClient& client() const { return *lesson().station; }
    [[nodiscard]] bool has_wrench() const { return client().latest.input.grip == servo::Grip::wrench; }
    [[nodiscard]] bool engaged() const { return client().latest.output.joint >= 0; }

    // The trainee waits while the hand is busy with the clutch or changes the tool.
    void think() {
        if (clutching_ > 0.0 || changes_tool_) return;
        const session::LessonSession& session = *lesson().session;
        intention_ = trainee_.intend(session.setup(), session.state(), session.lesson(),
                                     client().latest.commanded_tool);
        (void)trainee_.take_events();
    }

    Goal next_goal() {
        const bool wants_wrench = intention_.grip == servo::Grip::wrench;
        changes_tool_ = wants_wrench != has_wrench() && !engaged();
        if (!changes_tool_) return {intention_.tool, intention_.grip != servo::Grip::none ? dead_man : 0U};
        if (!wants_wrench) {
            if (time_ > tool_key_pressed_ + 1.0) {
                tool_key_pressed_ = time_;
                trainer_.key(platform::Key::t);
            }
            return {client().latest.commanded_tool, 0U};
        }
        // The hand comes from above and closes beside the handle.
        const Pose rest = client().latest.resting_wrench.value_or(client().rest);
        Pose above = rest;
        above.position += Vec3(0.0, 0.03, 0.0);
        const bool closes = client().near_wrench && std::fmod(time_, 0.5) < 0.25;
        return {above, closes ? dead_man : 0U};
    }

    // Corrects a part of the distance between the tool and its goal, in the frame of the device.
    void move(const Pose& goal, double seconds) {
        const station::DeviceLayout& layout = client().link->layout();
        const Vec3 reach = used_reach * layout.mover->half_workspace;
        if (clutching_ > 0.0) {
            clutching_ -= seconds;
            if (clutching_ < 0.8 * clutch_time) pose_.position = before_clutch_ * -0.5;
            hand_.lead_to(pose_);
            return;
        }
        const Pose tool = client().latest.commanded_tool;
        const double handle_length = lesson().session->setup().wrench.handle_length;
        const Vec3 grip(has_wrench() ? station::lever_arm_of(layout, handle_length) : 0.0, 0.0, 0.0);
        const Vec3 right = client().controls.view * Vec3(1.0, 0.0, 0.0);
        const Quat heading = glm::angleAxis(std::atan2(-right.z, right.x), Vec3(0.0, 1.0, 0.0));
        const Quat to_device = glm::conjugate(heading * layout.workspace.rotation);
        const double share = std::min(1.0, gain * seconds);
        pose_.position += force::clamp_length(
            share / layout.workspace.scale * (to_device * (goal * grip - tool * grip)), hand_speed * seconds);
        const Vec3 turn = to_device * turn_between(tool.orientation, goal.orientation);
        if (!engaged() || grip.x == 0.0)
            pose_.orientation =
                glm::normalize(rotation(force::clamp_length(std::min(1.0, turn_gain * seconds) * turn,
                                                            turn_speed * seconds)) *
                               pose_.orientation);
        const Vec3 beyond = glm::abs(pose_.position) - reach;
        if (std::max({beyond.x, beyond.y, beyond.z}) > 0.0) {
            pose_.position = glm::clamp(pose_.position, -reach, reach);
            before_clutch_ = pose_.position;
            clutching_ = clutch_time;
            ++clutched;
        }
        hand_.lead_to(pose_);
    }

    HeadlessTrainer& trainer_;
    const HeldArm& arm_;
    SteadyHand hand_;
    trainees::SimulatedTrainee trainee_;
    trainees::IntendedPose intention_;
    Pose pose_;  // where the hand is led, device frame
    Vec3 before_clutch_{0.0};
    double time_ = 0.0, clutching_ = 0.0;  // s
    double tool_key_pressed_ = -1.0;       // s
    bool changes_tool_ = false;
    std::uint64_t tick_ = 0;
};

// Puts the emulated library where the vendor's archive has it, and returns the hand that holds its arm.
std::unique_ptr<HeldArm> connect(const std::string& vendor, const fs::path& folder,
                                 std::unique_ptr<emulate::EmulatedHaply>& service) {
    fs::remove_all(folder);
    if (vendor == "force-dimension") {
        fs::create_directories(folder / "lib/release/lin-x86_64-gcc");
        fs::create_symlink(BOLT_EMULATED_FORCE_DIMENSION, folder / "lib/release/lin-x86_64-gcc/libdrd.so.3");
        setenv("FDSDK", folder.c_str(), 1);
        return force_dimension_arm(false, ArmClock::real_time);
    }
    if (vendor == "open-haptics") {
        fs::create_directories(folder / "lib");
        fs::create_symlink(BOLT_EMULATED_OPEN_HAPTICS, folder / "lib/libHD.so.3.4");
        setenv("OH_SDK_BASE", folder.c_str(), 1);
        return open_haptics_arm(ArmClock::real_time);
    }
    REQUIRE_MESSAGE(vendor == "haply", "expected force-dimension, open-haptics or haply");
    emulate::EmulatedHaplyOptions options;
    options.port = 0;
    auto started = emulate::EmulatedHaply::start(options);
    REQUIRE(started);
    service = std::move(*started);
    setenv("BOLTWRIGHT_HAPLY", ("127.0.0.1:" + std::to_string(service->port())).c_str(), 1);
    auto arm = std::make_unique<HeldArm>();
    arm->name = "Haply";
    // The service's frame has x to the right, y forward and z up.
    arm->intend = [&service](const Pose& pose) {
        const Quat& q = pose.orientation;
        service->intend({pose.position.x, -pose.position.z, pose.position.y});
        service->turn({q.w, q.x, -q.z, q.y});
    };
    arm->press = [&service](std::uint32_t buttons) { service->press(buttons); };
    return arm;
}

}  // namespace

TEST_CASE("Arm at a desk: a simulated trainee plays a lesson with the device that the program finds") {
    const char* wanted = std::getenv("BOLTWRIGHT_PLAY");
    if (wanted == nullptr)
        return skip_rest("it takes the minutes of a lesson; BOLTWRIGHT_PLAY=\"haply first-nut\" plays it");
    std::istringstream words(wanted);
    std::string vendor, assembly;
    words >> vendor >> assembly;
    std::unique_ptr<emulate::EmulatedHaply> service;
    const fs::path folder = fs::path(BOLT_TRAINER_OUT) / "arm_at_desk";
    const auto arm = connect(vendor, folder / "sdk", service);
    trainer::AppOptions options = test::options(assembly.c_str(), false);
    for (int i = 0; i < 100 && options.choice.equipment.devices.empty(); ++i) {
        options.choice.equipment = trainer::default_equipment();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    REQUIRE_FALSE(options.choice.equipment.devices.empty());
    options.out = folder / vendor;
    HeadlessTrainer trainer(std::move(options));
    std::optional<Player> player;
    using Clock = std::chrono::steady_clock;
    const Clock::time_point began = Clock::now();
    double last = 0.0, reported = 0.0;
    while (trainer.app().screen() != trainer::ShownScreen::result && last < longest_lesson) {
        const double now = std::chrono::duration<double>(Clock::now() - began).count();
        trainer.frame({}, now - last);
        if (trainer.app().screen() == trainer::ShownScreen::lesson) {
            if (!player) player.emplace(trainer, *arm);
            player->play(now - last);
        }
        last = now;
        if (player && now > reported + 10.0) {
            reported = now;
            player->report(now);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    for (const std::string& line : trainer.log()) MESSAGE(line);
    REQUIRE(trainer.outcome());
    CHECK(trainer.outcome()->result.finished);
    CHECK(trainer.outcome()->result.score >= 80.0);
    MESSAGE(arm->name << ", " << assembly << ": score " << trainer.outcome()->result.score << " in "
                      << trainer.lesson().session->time() << " s; force at most " << player->largest_force
                      << " N; clutch pressed " << player->clutched << " times");
}
