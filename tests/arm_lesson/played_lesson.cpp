#include "tests/arm_lesson/played_lesson.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "game/lesson/lesson.hpp"
#include "game/lesson/step_requirements.hpp"
#include "haptics/station/station.hpp"

namespace bolt::test {

namespace {

constexpr double used_reach = 0.9;     // share of the arm's reach that the hand uses
constexpr double hand_speed = 0.6;     // m/s, at most
constexpr double turn_rate = 6.0;      // rad/s, at most
constexpr double clutch_speed = 0.3;   // m/s, mean
constexpr double clutch_time = 0.25;   // s, at least
constexpr double settling_time = 0.1;  // s after the clutch
constexpr double push_time = 0.12;     // s in which the hand braces against a steady force
constexpr std::uint32_t dead_man = 1, clutch = 2;

}  // namespace

PlayedLesson::PlayedLesson(HeldArm& arm, const content::Assembly& assembly, session::LessonOptions options,
                           const std::filesystem::path& file)
    : arm_(arm), supervisor_(std::make_unique<device::DeviceSupervisor>(arm.open, arm.timer)) {
    arm_.press(dead_man);
    now_ = arm_.timer.now();
    while (!supervisor_->status().description) {
        serve();
        REQUIRE_MESSAGE(arm_.timer.now() < now_ + 5.0, supervisor_->status().fault_message);
    }
    auto own = session::prepare_session(assembly, options);
    auto recorded = session::prepare_session(assembly, options);
    REQUIRE(own);
    REQUIRE(recorded);
    station_ = std::move(*own);
    trainee_.emplace(*trainees::find_profile("expert"), options.seed, station_.setup);
    station::StationOptions planned;
    for (const servo::ToolSetup& tool : station_.setup.tools)
        planned.handle_length = std::max(planned.handle_length, tool.wrench.handle_length);
    planned.home = trainee_->hand();
    auto layout = station::make_layout(planned, *supervisor_->status().description, {});
    REQUIRE(layout);
    layout_ = std::move(*layout);
    state_ = station::initial_state(layout_);
    options.device_limits = station::limits_of(layout_);
    session::set_device_limits(options, station_);
    session::set_device_limits(options, *recorded);
    auto begun = session::LessonSession::begin(std::move(*recorded), options, file);
    REQUIRE(begun);
    session_ = std::move(*begun);
    world::add_haptics(world_, session_->state());
    now_ = arm_.timer.now();
}

void PlayedLesson::serve() { device::run_once(*supervisor_, mailboxes_, snapshot_); }

Pose PlayedLesson::device_pose(const Pose& tool) const {
    const force::WorkspaceState& w = state_.workspace;
    const Quat back = glm::conjugate(w.heading * layout_.workspace.rotation);
    return {back * (force::lever_end(w, tool) - w.centre) / layout_.workspace.scale,
            glm::normalize(back * tool.orientation * glm::conjugate(w.tool_to_device))};
}

// The intention is a pose of the tool. Beyond the arm's reach the hand presses the clutch and goes back.
void PlayedLesson::move_hand(const trainees::IntendedPose& intention) {
    const double dt = station_.setup.dt;
    const Pose wanted = device_pose(intention.tool);
    const Vec3 reach = used_reach * layout_.mover->half_workspace;
    const Vec3 beyond = glm::abs(wanted.position) - reach;
    const bool out = reach != Vec3(0.0) && std::max({beyond.x, beyond.y, beyond.z}) > 0.0;
    if (!clutching_ && settling_ <= 0.0 && out) {
        const Vec3 inside = glm::clamp(wanted.position, -reach, reach);
        const Vec3 to = -0.4 * inside;
        clutching_ = Clutching{0.0, std::max(clutch_time, glm::distance(hand_.position, to) / clutch_speed),
                               hand_.position, to};
        ++felt_.clutched;
    }
    if (clutching_) {
        Clutching& c = *clutching_;
        c.elapsed += dt;
        // The clutch is pressed before the hand goes back, and released after it has arrived.
        const double going = std::clamp((c.elapsed - 0.05) / c.duration, 0.0, 1.0);
        hand_.position = glm::mix(c.from, c.to, minimum_jerk(going));
        push_ = Vec3(0.0);
        arm_.press(dead_man | clutch);
        if (c.elapsed > c.duration + 0.15) {
            clutching_.reset();
            settling_ = settling_time;
        }
        arm_.intend(hand_);
        return;
    }
    arm_.press(dead_man);
    const Vec3 step = wanted.position - hand_.position;
    const Vec3 moved = force::clamp_length(step, hand_speed * dt);
    hand_.position += moved;
    if (state_.pivot_joint < 0) {
        const Vec3 turn =
            force::clamp_length(turn_between(hand_.orientation, wanted.orientation), turn_rate * dt);
        hand_.orientation = glm::normalize(rotation(turn) * hand_.orientation);
    }
    // A planned motion has no lag, and a hand that turns a nut braces against its steady force.
    const Vec3 against =
        intention.holds_nut && arm_.braces ? -arm_.force().force / arm_.stiffness : Vec3(0.0);
    push_ += (against - push_) * std::min(1.0, dt / push_time);
    Pose intended = hand_;
    intended.position += push_ + moved / dt * (arm_.damping / arm_.stiffness);
    arm_.intend(intended);
}

void PlayedLesson::tick() {
    const double dt = station_.setup.dt;
    const bool waits = hand_rests || clutching_ || settling_ > 0.0;
    settling_ = std::max(0.0, settling_ - dt);
    if (!waits) {
        intention_ = trainee_->intend(session_->setup(), session_->state(), session_->lesson(),
                                      state_.workspace.commanded_tool);
        (void)trainee_->take_events();
    }
    if (!hand_rests) move_hand(intention_);

    now_ += dt;
    while (arm_.timer.now() < now_) serve();
    controls_.grip = intention_.grip;
    controls_.guided_joint = intention_.guided_joint;
    controls_.tool = intention_.tool_index;
    controls_.second_wrench = intention_.second_wrench;
    controls_.set_torque = static_cast<float>(lesson::wrench_set_torque(session_->lesson()));
    station::StationInputs inputs;
    mailboxes_.snapshots.update();
    inputs.mover = mailboxes_.snapshots.latest();
    inputs.controls = controls_;
    std::vector<station::StationCommand> commands;
    if (session_->target_checkpoints() > checkpoints_sent_) {
        commands.emplace_back(station::SaveCheckpoint{});
        ++checkpoints_sent_;
    }
    inputs.commands = commands;
    const station::StationTick before = latest_;
    const station::StationStep done =
        station::step(layout_, station_.setup, state_, station_.state, inputs, ++number_);
    mailboxes_.commands.write({done.commands.mover, true, ++command_number_});
    latest_ = done.tick;
    const Status repeated = session_->repeat(world_, latest_.input, latest_.output);
    REQUIRE_MESSAGE(repeated, (repeated ? "" : repeated.error().message()));
    measure(before);
}

void PlayedLesson::measure(const station::StationTick& before) {
    const force::OutputCommand on_hand = arm_.force();
    const double force = glm::length(on_hand.force), torque = glm::length(on_hand.torque);
    felt_.force = std::max(felt_.force, force);
    felt_.torque = std::max(felt_.torque, torque);
    if (latest_.output.joint >= 0) {
        felt_.force_on_bolt = std::max(felt_.force_on_bolt, force);
        felt_.torque_on_bolt = std::max(felt_.torque_on_bolt, torque);
    }
    felt_.force_step = std::max(felt_.force_step, glm::distance(on_hand.force, last_force_));
    last_force_ = on_hand.force;
    if (number_ > 1)
        felt_.largest_tool_jump =
            std::max(felt_.largest_tool_jump,
                     glm::distance(before.commanded_tool.position, latest_.commanded_tool.position));
}

session::LessonOutcome PlayedLesson::finish() {
    auto outcome = session_->finish(world_);
    REQUIRE(outcome);
    return *outcome;
}

}  // namespace bolt::test
