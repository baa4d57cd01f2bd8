#include "game/trainees/trainee.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "game/motion/path_planning.hpp"
#include "game/trainees/behaviour.hpp"

namespace bolt::trainees {

namespace {

using servo::Grip;

constexpr double frame_time = 1.0 / 60.0;   // s
constexpr double alignment_radius = 0.06;   // m from the nut, in which the wrench is being aligned
constexpr double arm_lag = 0.2;             // s, of a force-feedback arm that turns with the hand
constexpr double swing_back_time = 0.4;     // s, of a ratchet
constexpr double visibility_change = 0.02;  // smallest change that is reported

// Starts the stroke once the nut is held. If the tool missed the nut, it is placed again at another angle.
void engage(TraineeState& t, const Pose& pose) {
    if (t.holds_intended_nut()) {
        t.stroke_start = t.handle_angle;
        t.nut_angle_at_stroke = t.joint().nut.angle;
        t.consecutive_misses = 0;
        t.enter(t.plan.fingers ? Phase::spin : Phase::pull);
    } else if (t.phase_over()) {
        ++t.consecutive_misses;
        if (t.obstacles() != nullptr && !t.plan.fingers) {
            start_lift(t, pose, 0.2);
            return;
        }
        t.placement_error = t.random_offset(0.7 * t.profile.position_noise);
        choose_handle_angle(t);
        t.enter(Phase::engage, 0.15);
    }
}

// Records the visible fraction of the due nut, once per frame while the wrench is being aligned with it.
void report_visibility(TraineeState& t, const lesson::LessonStep* due) {
    const auto frame = static_cast<std::uint64_t>(std::max(1.0, frame_time / t.setup->dt));
    if (due == nullptr || t.obstacles() == nullptr || !t.holds_wrench || t.servo_state->tick % frame != 0)
        return;
    if (t.servo_state->engagement.joint >= 0) return;
    const servo::NutGeometry& nut = t.setup->nuts[due->joint];
    if (glm::distance(t.hand.position, nut.seat) > alignment_radius) return;
    const double share = motion::nut_visibility(t.visibility, *t.obstacles(), due->joint, t.visibility.eye);
    if (t.reported_joint == due->joint && std::abs(share - t.reported_visibility) < visibility_change) return;
    t.reported_visibility = share;
    t.reported_joint = due->joint;
    t.events.push_back({t.servo_state->tick, lesson::EventKind::visibility, static_cast<int>(due->joint),
                        share, fmt::format("{:.0f} % of the nut is seen", 100.0 * share)});
}

// Advances the phase by one tick. Returns the intended pose of the tool and sets `grip` if it is closed.
Pose step_phase(TraineeState& t, const Percept& felt, Grip& grip) {
    const Grip own = t.plan.fingers ? Grip::fingers : Grip::wrench;
    Pose pose = t.from;
    switch (t.phase) {
        case Phase::pause:
            if (t.phase_over()) begin_next_action(t);
            pose = t.from;
            break;
        case Phase::search_view:
            if (t.phase_over()) start_reach(t);
            pose = t.from;
            break;
        case Phase::change_tool:
            pose = motion::arc_pose(t.from, t.to, motion::minimum_jerk(t.progress()), t.bulge);
            if (!t.phase_over() || start_next_waypoint(t, Phase::change_tool)) break;
            t.holds_wrench = !t.plan.fingers && t.setup->nuts[t.plan.joint].tool == t.setup->tool;
            t.enter(Phase::pause, 0.2);
            break;
        case Phase::reach:
            pose = motion::arc_pose(t.from, t.to, motion::minimum_jerk(t.progress()), t.bulge);
            if (!t.phase_over() || start_next_waypoint(t, Phase::reach)) break;
            t.enter(Phase::lower, t.profile.placing_time * t.random.uniform(0.8, 1.3));
            break;
        case Phase::lower:
            pose =
                motion::arc_pose(t.from, t.tool_at_nut(0.0), motion::minimum_jerk(t.progress()), Vec3(0.0));
            if (t.phase_over()) t.enter(Phase::engage, 0.12);
            break;
        case Phase::engage:
            grip = own;
            pose = t.tool_at_nut(0.0);
            engage(t, pose);
            break;
        case Phase::pull:
            grip = own;
            pull(t, felt);
            notice_common_turn(t);
            pose = t.tool_at_nut(0.0);
            if (!t.holds_intended_nut()) start_lift(t, pose, 0.3);  // the jaw slipped off
            break;
        case Phase::unload:
            grip = own;
            unload(t);
            pose = t.tool_at_nut(0.0);
            if (!t.phase_over()) break;
            if (pulls_again(t)) {
                t.stroke_end = t.handle_angle;
                t.enter(Phase::swing_back, swing_back_time);
            } else {
                start_lift(t, pose, 0.25);
            }
            break;
        case Phase::swing_back:
            grip = own;
            swing_back(t);
            pose = t.tool_at_nut(0.0);
            if (t.phase_over()) notice_free_nut(t);
            if (!t.holds_intended_nut() || t.plan.finished)
                start_lift(t, pose, 0.3);
            else if (t.phase_over())
                t.enter(Phase::engage, 0.12);
            break;
        case Phase::lift: {
            pose = motion::arc_pose(t.from, t.to, motion::minimum_jerk(t.progress()), Vec3(0.0));
            if (!t.phase_over()) break;
            t.from = t.to;
            const bool done = t.plan.finished || t.step_is_past();
            t.enter(Phase::pause, done ? t.profile.pause * t.random.uniform(0.3, 1.7) : 0.05);
            break;
        }
        case Phase::spin:
            grip = own;
            spin(t, felt);
            pose = t.tool_at_nut(0.0);
            break;
        case Phase::spin_back:
            spin_back(t);
            pose = t.tool_at_nut(0.0);
            if (!t.phase_over()) break;
            if (t.plan.finished || t.step_is_past())
                start_lift(t, pose, 0.3);
            else
                t.enter(Phase::engage, 0.05);
            break;
        case Phase::done:
            break;
    }
    return pose;
}

}  // namespace

SimulatedTrainee::SimulatedTrainee(const TraineeProfile& profile, std::uint64_t seed,
                                   const servo::Setup& setup, motion::ViewHelper help)
    : state_(std::make_unique<TraineeState>(profile, seed, setup)) {
    TraineeState& state = *state_;
    state.view_help = std::move(help);
    Vec3 centre(0.0);
    for (const servo::NutGeometry& nut : setup.nuts)
        centre += nut.seat / static_cast<double>(setup.nuts.size());
    state.from.position = centre + Vec3(0.0, 0.3, 0.4);  // the hand rests in front of the assembly
    state.to = state.rest = state.hand = state.from;
    state.visibility.eye = centre + Vec3(0.0, 0.45, 0.6);  // the head is above the hand
}

SimulatedTrainee::SimulatedTrainee(SimulatedTrainee&&) noexcept = default;
SimulatedTrainee& SimulatedTrainee::operator=(SimulatedTrainee&&) noexcept = default;
SimulatedTrainee::~SimulatedTrainee() = default;

namespace {

// Perceives the previous tick and advances the phase. Does not move the hand.
IntendedPose advance(TraineeState& t, const servo::Setup& setup, const servo::State& state,
                     const lesson::Lesson& lesson) {
    t.setup = &setup;
    t.servo_state = &state;
    t.lesson = &lesson;
    // The trainee's eye begins in the first view of the assembly, if there is one.
    if (t.time <= 0.0 && !lesson.assembly->views.empty())
        t.visibility.eye = lesson.assembly->views.front().eye;
    t.time += setup.dt;

    IntendedPose intended;
    const lesson::LessonStep* due = lesson.due();
    if (due != nullptr && lesson.guides) intended.guided_joint = static_cast<std::int16_t>(due->joint);
    // A hand that holds a nut does not yield to forces; a free hand does. While the wrench is being lowered
    // the jaw may already be on the nut, but the hand does not hold it yet.
    const bool holds_nut = state.engagement.joint >= 0 && t.phase != Phase::lower;
    const bool grasps = holds_nut && !t.held_nut;
    if (grasps && t.holds_intended_nut()) adopt_wrench_pose(t);
    const force::OutputCommand output{state.output_stage.limiter.force, state.output_stage.limiter.torque};
    const double torque =
        felt_torque(setup.torque_rendering, t.nut(), t.hand.orientation * Vec3(1, 0, 0), output);
    const Percept& felt = t.perception.update(holds_nut ? torque : 0.0, t.handle_angle, t.joint().nut.speed,
                                              holds_nut, holds_nut && state.engagement.swung > 0.0);
    Pose pose = step_phase(t, felt, intended.grip);
    if (t.phase != Phase::done) {
        pose.position += t.tremor.at(t.time) * t.profile.tremor;
        if (t.phase == Phase::pull) {
            const double sway = t.profile.tremor_torsion * t.tremor.torsion(t.time);
            pose.orientation = motion::tool_orientation(t.nut(), t.handle_angle + sway, t.flipped);
        }
    }
    if (t.obstacles() != nullptr && t.holds_wrench) intended.grip = Grip::wrench;
    intended.tool = pose;
    intended.tool_index = t.tool;
    intended.second_wrench = t.second_wrench;
    intended.holds_nut = holds_nut;
    return intended;
}

}  // namespace

servo::TickInput SimulatedTrainee::act(const servo::Setup& setup, const servo::State& state,
                                       const lesson::Lesson& lesson) {
    TraineeState& t = *state_;
    const IntendedPose intended = advance(t, setup, state, lesson);
    const bool holds_nut = intended.holds_nut;
    // The intended pose may have jumped; the hand stays in place.
    if (holds_nut != t.held_nut || t.intended_pose_jumped)
        reset_deflection(t.deflection, t.hand, intended.tool);
    t.held_nut = holds_nut;
    t.intended_pose_jumped = false;
    const force::OutputCommand output{state.output_stage.limiter.force, state.output_stage.limiter.torque};
    t.hand = step_deflection(t.profile.impedance, t.deflection, intended.tool, output, holds_nut, setup.dt);
    if (t.obstacles() != nullptr && t.holds_wrench && t.obstacles()->in_hand) {
        const Pose& wrench = t.obstacles()->god_object.constrained_tool;
        retreat_if_caught(t, intended.tool, wrench);
        if (holds_nut) t.hand = motion::give_way_to_wrench(t.hand, wrench);
    }
    servo::TickInput input;
    input.dead_man = true;
    input.guided_joint = intended.guided_joint;
    input.grip = intended.grip;
    input.tool = intended.tool_index;
    input.second_wrench = t.second_wrench;
    input.commanded_tool = servo::to_commanded_tool(t.hand);
    report_visibility(t, lesson.due());
    return input;
}

IntendedPose SimulatedTrainee::intend(const servo::Setup& setup, const servo::State& state,
                                      const lesson::Lesson& lesson, const Pose& hand) {
    TraineeState& t = *state_;
    t.hand = hand;
    t.arm_lag = arm_lag;
    const IntendedPose intended = advance(t, setup, state, lesson);
    t.held_nut = intended.holds_nut;
    t.intended_pose_jumped = false;
    if (t.obstacles() != nullptr && t.holds_wrench && t.obstacles()->in_hand)
        retreat_if_caught(t, intended.tool, t.obstacles()->god_object.constrained_tool);
    report_visibility(t, lesson.due());
    return intended;
}

const Pose& SimulatedTrainee::hand() const { return state_->hand; }

std::vector<lesson::LessonEvent> SimulatedTrainee::take_events() { return std::exchange(state_->events, {}); }

namespace {

// The tick at which a trainee last came nearer to the end of its step: the step began, or its nut turned
// further than before.
struct ProgressClock {
    std::size_t step = SIZE_MAX;  // index into Lesson::steps
    double furthest = 0.0;        // rad, of its nut, in the direction of the step
    std::uint64_t tick = 0;

    void update(const lesson::Lesson& lesson, const servo::State& state) {
        const lesson::LessonStep* due = lesson.due();
        if (due == nullptr) return;
        constexpr double least = to_radians(5.0);
        const double sign = due->kind == lesson::StepKind::loosen ? -1.0 : 1.0;
        const double angle = sign * state.joints[due->joint].nut.angle;
        if (lesson.current == step && angle < furthest + least) return;
        step = lesson.current;
        furthest = angle;
        tick = state.tick;
    }
};

}  // namespace

Result<session::LessonOutcome> train(const content::Assembly& assembly, const TrainOptions& options,
                                     const std::filesystem::path& file,
                                     const std::function<bool(const TrainingProgress&)>& watch) {
    session::LessonOptions lesson_options = options.lesson;
    lesson_options.trainee_profile = options.trainee.name;
    lesson_options.view_help = static_cast<bool>(options.view_help);
    Result<std::unique_ptr<session::LessonSession>> started =
        session::LessonSession::begin(assembly, lesson_options, file);
    if (!started) return fail(started.error());
    session::LessonSession& session = **started;
    world::World world;
    world::add_haptics(world, session.state());
    const double dt = options.lesson.dt;
    SimulatedTrainee trainee(options.trainee, options.lesson.seed, session.setup(), options.view_help);
    const auto second = static_cast<std::uint64_t>(std::lround(1.0 / dt));
    const auto last = static_cast<std::uint64_t>(options.time_limit / dt);
    const auto patience = static_cast<std::uint64_t>(options.patience / dt);
    const servo::State& state = session.state();
    const lesson::Lesson& lesson = session.lesson();
    ProgressClock made;
    bool running = true;
    while (running && state.tick - made.tick < patience && !session.finished() && state.tick < last) {
        const servo::TickInput input = trainee.act(session.setup(), state, lesson);
        const Result<servo::Output> output = session.tick(world, input, trainee.take_events());
        if (!output) return fail(output.error());
        TrainingProgress progress{session.time(), lesson.current, lesson.steps.size(), nullptr};
        for (const lesson::LessonEvent& event : session.events()) {
            progress.event = &event;
            running = watch(progress) && running;
            progress.event = nullptr;
        }
        made.update(lesson, state);
        if (state.tick % second == 0) running = watch(progress) && running;
    }
    return session.finish(world);
}

}  // namespace bolt::trainees
