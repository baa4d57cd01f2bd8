#include "game/lesson/lesson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "game/lesson/fastener_names.hpp"
#include "game/lesson/step_requirements.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::lesson {

namespace {

constexpr double recheck_turn = to_radians(0.2);  // nut angle by which a re-check counts as moving the nut
constexpr double turning_speed = 0.01;            // rad/s
constexpr double wrong_way = to_radians(5.0);     // nut angle; more than play and the wrench's elasticity
constexpr double turn_excess = to_radians(1.0);   // nut angle beyond the window that is reported
constexpr double max_bend = to_radians(1.0);      // rad in a hold; more is a mistake
constexpr std::uint64_t assessment_end_ticks = 3000;
constexpr std::uint64_t regrip_ticks = 1000;          // gap within which a grip by fingers continues the hold
constexpr double working_torque = 0.5;                // N·m; less is only a touch
constexpr double max_common_turn = to_radians(10.0);  // rad in a hold; more is a mistake

using world::joint_at;

std::uint64_t tick_of(const world::ReadHaptics& world) { return world.only<world::ServoClock>().tick; }

const content::Specification& spec_of(const Lesson& lesson, std::size_t joint) {
    return lesson.assembly->joints[joint].spec;
}

void add_event(Lesson& lesson, std::uint64_t tick, EventKind kind, int joint, double value,
               std::string text) {
    lesson.events.push_back({tick, kind, joint, value, std::move(text), MistakeKind::none});
}

void add_mistake(Lesson& lesson, std::uint64_t tick, MistakeKind kind, std::size_t joint, double value,
                 std::string text) {
    lesson.events.push_back(
        {tick, EventKind::mistake, static_cast<int>(joint), value, std::move(text), kind});
}

void begin_step(Lesson& lesson, const world::ReadHaptics& world) {
    const LessonStep* step = lesson.due();
    if (step == nullptr) return;
    if (lesson.announced_pass != step->pass) {
        lesson.announced_pass = step->pass;
        const bool shares = step->kind == StepKind::tighten || step->kind == StepKind::turn;
        const std::string share = shares ? fmt::format(" to {:.0f} %", 100 * step->fraction) : "";
        add_event(lesson, tick_of(world), EventKind::pass_begin, -1, step->pass,
                  fmt::format("{}{}", name(step->kind), share));
    }
    JointTrack& track = lesson.joints[step->joint];
    track.peak_torque = 0.0;
    track.clicked = false;
    track.begin_angle = joint_at(world, step->joint).angle;
    const bool seated = joint_at(world, step->joint).stage != joint::Stage::navigation;
    if (step->kind == StepKind::turn && seated && !track.mark) track.mark = track.begin_angle;
    lesson.step_starts.resize(lesson.current);
    lesson.step_starts.push_back(lesson.joints);
    add_event(lesson, tick_of(world), EventKind::step_begin, static_cast<int>(step->joint), step->torque,
              std::string(name(step->kind)));
}

void end_step(Lesson& lesson, const world::ReadHaptics& world) {
    const LessonStep step = *lesson.due();
    JointTrack& track = lesson.joints[step.joint];
    track.done_in_pass = step.pass;
    if (step.kind == StepKind::loosen) {
        track.result.torque = std::max(track.result.torque, track.peak_torque);
        track.result.angle += track.begin_angle - joint_at(world, step.joint).angle;
    } else if (step.kind == StepKind::tighten || step.kind == StepKind::turn) {
        track.result.torque = track.peak_torque;
    }
    add_event(lesson, tick_of(world), EventKind::step_end, static_cast<int>(step.joint), track.peak_torque,
              std::string(name(step.kind)));
    ++lesson.current;
    begin_step(lesson, world);
}

// Reports work on a joint that is not due.
void report_out_of_turn(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    const LessonStep& due = *lesson.due();
    JointTrack& track = lesson.joints[joint];
    const std::string& id = track.result.id;
    const bool done = track.done_in_pass == due.pass;
    // After spinning a nut down, a trainee grips it once more to check that it is seated. Fingers cannot turn
    // a seated nut.
    if (lesson.grip == servo::Grip::fingers &&
        (done || joint_at(world, joint).stage != joint::Stage::navigation))
        return;
    if (done) {
        ++track.result.done_already;
        add_mistake(lesson, tick_of(world), MistakeKind::done_already, joint, 0.0,
                    fmt::format("{} was done already in this pass", id));
        return;
    }
    ++track.result.out_of_turn;
    add_mistake(lesson, tick_of(world), MistakeKind::out_of_turn, joint, 0.0,
                fmt::format("{} is not the next joint; {} is", id, lesson.joints[due.joint].result.id));
}

void engage(Lesson& lesson, int joint, servo::Grip grip, const world::ReadHaptics& world) {
    // Fingers spin a nut with many short grips, so `worked` stays set in a grip that soon follows the last.
    const bool again = grip == servo::Grip::fingers && lesson.grip == grip &&
                       lesson.last_held_joint == joint && tick_of(world) - lesson.released_at < regrip_ticks;
    lesson.held_joint = joint;
    lesson.grip = grip;
    JointTrack& track = lesson.joints[static_cast<std::size_t>(joint)];
    track.worked = again && track.worked;
    track.wrong_way_reported = track.seated = track.common_turn_reported = track.bend_reported = false;
    track.bent_at_grip = world.only<world::ToolState>().bent;
    track.furthest = joint_at(world, static_cast<std::size_t>(joint)).angle;
    track.common_turn = track.common_turn_at_grip =
        joint_at(world, static_cast<std::size_t>(joint)).common_turn;
    track.peak_at_grip = track.peak_torque;
    add_event(lesson, tick_of(world), EventKind::engage, joint, 0.0,
              fmt::format("{} on the {}", grip == servo::Grip::wrench ? "wrench" : "fingers",
                          fastener_name(lesson.assembly->joints[static_cast<std::size_t>(joint)].design)));
}

void release(Lesson& lesson, const world::ReadHaptics& world) {
    const auto joint = static_cast<std::size_t>(lesson.held_joint);
    JointTrack& track = lesson.joints[joint];
    add_event(lesson, tick_of(world), EventKind::release, lesson.held_joint, track.peak_torque, {});
    track.result.clamp_at_release = joint_at(world, joint).clamp;
    if (track.worked && lesson.grip == servo::Grip::wrench) ++track.result.strokes;
    lesson.last_held_joint = lesson.held_joint;
    lesson.held_joint = -1;
    lesson.released_at = tick_of(world);
    const LessonStep* due = lesson.due();
    if (due != nullptr && due->joint == joint && step_fulfilled(lesson, world)) end_step(lesson, world);
}

// Reports a tool that the trainee should not have chosen, once a lesson.
void report_tool_choice(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    const ToolFault fault = joint < lesson.tool_faults.size() ? lesson.tool_faults[joint] : ToolFault::none;
    if (fault == ToolFault::none || lesson.reported_tool_fault != ToolFault::none) return;
    lesson.reported_tool_fault = fault;
    const content::AssemblyJoint& turned = lesson.assembly->joints[joint];
    const double bearable = tool_models::bearable_torque(*lesson.tools[joint]);
    if (fault == ToolFault::too_weak)
        add_mistake(lesson, tick_of(world), MistakeKind::weak_tool, joint, bearable,
                    fmt::format("{} needs up to {:.0f} N·m, the tool bears {:.0f} N·m", turned.design.id,
                                turned.spec.torque.high, bearable));
    else
        add_mistake(lesson, tick_of(world), MistakeKind::torque_wrench_loosens, joint, bearable,
                    fmt::format("{} is loosened with a torque wrench", turned.design.id));
}

// Called at the first work of a hold: checks the tool, and that this joint is due.
void begin_work(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    lesson.joints[joint].worked = true;
    if (lesson.grip == servo::Grip::wrench) report_tool_choice(lesson, joint, world);
    const LessonStep* due = lesson.due();
    if (due == nullptr || due->joint == joint) return;
    const bool due_step_begun =
        lesson.mode == Mode::assessment && lesson.joints[due->joint].peak_torque > working_torque;
    const bool is_next =
        lesson.current + 1 < lesson.steps.size() && lesson.steps[lesson.current + 1].joint == joint;
    if (due_step_begun && is_next) {
        end_step(lesson, world);  // judged in its present state
        return;
    }
    report_out_of_turn(lesson, joint, world);
}

// Updates the highest torque that turned the nut, in all steps of a tightening lesson. `step_torque`: torque
// of the wrench in the direction of the task, N·m. It is divided by the breakaway factor (r in
// mechanistic.hpp), because a nut that is turned in small increments breaks away each time. The factor
// applies to friction only, but the whole torque is divided by it, so the result is slightly too low. A nut
// off its seat has no mark, torque or angle, and a later excess is reported again.
void update_turned_torque(Lesson& lesson, std::size_t index, const world::Joint& joint, double step_torque) {
    JointTrack& track = lesson.joints[index];
    if (lesson.task != Task::tighten) return;
    if (joint.stage == joint::Stage::navigation) {
        track.mark.reset();
        track.yielded = track.over_torque_reported = track.over_turn_reported = false;
        track.turned_torque = track.result.torque = track.result.angle = 0.0;
    }
    const double ratio = lesson.assembly->joints[index].design.friction.static_ratio;
    const double breakaway_factor = 1.0 + (ratio - 1.0) * joint.breakaway;
    if (joint.speed > turning_speed)
        track.turned_torque = std::max(track.turned_torque, step_torque / breakaway_factor);
}

// Reports excess torque, once until the nut leaves its seat. Breakaway torque does not turn the nut and does
// not count.
void report_excess_torque(Lesson& lesson, std::size_t joint, std::uint64_t tick) {
    JointTrack& track = lesson.joints[joint];
    const double highest = spec_of(lesson, joint).torque.high;
    if (track.over_torque_reported || track.turned_torque <= highest) return;
    track.over_torque_reported = true;
    ++track.over_torque_count;
    add_mistake(lesson, tick, MistakeKind::over_torque, joint, track.turned_torque,
                fmt::format("{} was turned with more than {:.1f} N·m", track.result.id, highest));
}

// Reports a nut that was turned too far from its mark, once until the nut leaves its seat.
void report_excess_angle(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    JointTrack& track = lesson.joints[joint];
    if (!lesson.turns_by_angle || track.over_turn_reported) return;
    const double turned = angle_from_mark(lesson, world, joint), most = spec_of(lesson, joint).angle.high;
    if (turned <= most + turn_excess) return;
    track.over_turn_reported = true;
    ++track.over_turn_count;
    add_mistake(lesson, tick_of(world), MistakeKind::over_turned, joint, turned,
                fmt::format("{} was turned by more than {:.0f}°", track.result.id, to_degrees(most)));
}

// Reports a nut that is turned the wrong way, once a hold. After excess torque or an excess angle it reports
// nothing, because turning back is then the correction.
void report_wrong_way(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    JointTrack& track = lesson.joints[joint];
    const world::Joint& now = joint_at(world, joint);
    const bool loosens = lesson.task == Task::loosen;
    const double beyond = (loosens ? -1.0 : 1.0) * (now.angle - track.furthest);
    if (beyond >= 0.0) {
        track.furthest = now.angle;
        track.seated = now.stage != joint::Stage::navigation;
    }
    if (beyond > -wrong_way || !track.seated || track.wrong_way_reported) return;
    if (track.over_torque_reported || track.over_turn_reported) return;
    track.wrong_way_reported = true;
    ++track.wrong_way_count;
    add_mistake(lesson, tick_of(world), loosens ? MistakeKind::tightened : MistakeKind::loosened, joint, 0.0,
                fmt::format("{} was turned the wrong way: that {} it", track.result.id,
                            loosens ? "tightens" : "loosens"));
}

// Reports a wrench that turns nut and bolt together, at most once per hold.
void report_common_turn(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    JointTrack& track = lesson.joints[joint];
    const double turned = joint_at(world, joint).common_turn - track.common_turn_at_grip;
    if (track.common_turn_reported || std::abs(turned) < max_common_turn) return;
    track.common_turn_reported = true;
    ++track.common_turn_count;
    add_mistake(lesson, tick_of(world), MistakeKind::turned_together, joint, turned,
                fmt::format("nut and bolt of {} turned together: nothing held the bolt", track.result.id));
}

// Reports a tool that bends, at most once per hold.
void report_bent_tool(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    JointTrack& track = lesson.joints[joint];
    if (track.bend_reported || world.only<world::ToolState>().bent - track.bent_at_grip < max_bend) return;
    track.bend_reported = true;
    ++track.bent_count;
    const double torque = std::abs(joint_at(world, joint).torque);
    add_mistake(lesson, tick_of(world), MistakeKind::tool_bent, joint, torque,
                fmt::format("the tool on {} bends at {:.0f} N·m", track.result.id, torque));
}

void observe_work(Lesson& lesson, std::size_t joint, const world::ReadHaptics& world) {
    JointTrack& track = lesson.joints[joint];
    const world::Joint& nut = joint_at(world, joint);
    const double torque = nut.torque;
    // Torque of the wrench in the direction of the task, N·m.
    const double step_torque = lesson.task == Task::loosen ? -torque : torque;
    const bool fingers = lesson.grip == servo::Grip::fingers;
    // Lifting the wrench off a finished nut can exert torque without turning the nut.
    const LessonStep* due = lesson.due();
    const bool leaves = !fingers && due != nullptr && due->joint != joint &&
                        lesson.last_held_joint == static_cast<int>(joint) && track.done_in_pass == due->pass;
    const bool works =
        leaves ? nut.speed > turning_speed : step_torque > working_torque || (fingers && step_torque > 0.01);
    if (!track.worked && works) begin_work(lesson, joint, world);
    // A pull that turns nut and bolt together says nothing about the clamp force: it does not count.
    const bool together = std::exchange(track.common_turn, nut.common_turn) != nut.common_turn;
    track.peak_torque = together ? track.peak_at_grip : std::max(track.peak_torque, step_torque);
    update_turned_torque(lesson, joint, nut, step_torque);
    report_excess_torque(lesson, joint, tick_of(world));
    report_excess_angle(lesson, joint, world);
    if (!fingers) report_wrong_way(lesson, joint, world);
    if (!fingers) report_common_turn(lesson, joint, world);
    if (!fingers) report_bent_tool(lesson, joint, world);
    // A nut that came off its seat during a step of kind `turn` has lost its mark; it gets a new one.
    const bool marks =
        !lesson.turns_by_angle || (due != nullptr && due->joint == joint && due->kind == StepKind::turn);
    if (!track.mark && marks && lesson.task == Task::tighten &&
        torque >= spec_of(lesson, joint).snug_torque && !fingers)
        track.mark = nut.angle;
    if (track.mark && torque > 0.0) track.result.angle = nut.angle - *track.mark;
    if (nut.stage == joint::Stage::yield) track.yielded = true;
    if (world.only<world::ToolState>().clicked) {
        track.clicked = true;
        add_event(lesson, tick_of(world), EventKind::click, static_cast<int>(joint), torque,
                  "the torque wrench clicks");
    }
    if (nut.stage != track.stage) {
        track.stage = nut.stage;
        add_event(lesson, tick_of(world), EventKind::stage, static_cast<int>(joint),
                  static_cast<double>(nut.stage), std::string(joint::name(nut.stage)));
    }
    const joint::JointCondition condition = nut.condition;
    if (condition != track.result.condition) {
        track.result.condition = condition;
        track.result.torque = std::max(track.result.torque, track.peak_torque);
        const MistakeKind kind =
            condition == joint::JointCondition::stripped ? MistakeKind::stripped : MistakeKind::broken;
        add_mistake(lesson, tick_of(world), kind, joint, torque,
                    fmt::format("{} is {}", track.result.id, joint::name(condition)));
    }
}

// An assessment ends when the last joint has been released for some time.
void end_assessment(Lesson& lesson, const world::ReadHaptics& world) {
    if (lesson.mode != Mode::assessment || lesson.held_joint >= 0 ||
        lesson.current + 1 != lesson.steps.size())
        return;
    const bool worked = lesson.joints[lesson.due()->joint].peak_torque > working_torque;
    if (worked && tick_of(world) - lesson.released_at > assessment_end_ticks) end_step(lesson, world);
}

}  // namespace

Lesson begin(const content::Assembly& assembly, Mode mode, Task task) {
    Lesson lesson;
    lesson.assembly = &assembly;
    lesson.mode = mode;
    lesson.task = task;
    lesson.guides = mode == Mode::guided;
    lesson.steps = make_plan(assembly, task);
    lesson.turns_by_angle = task == Task::tighten && turns_by_angle(assembly);
    lesson.tool_faults = faults_of_choice(assembly, task);
    for (const content::AssemblyJoint& joint : assembly.joints) {
        lesson.tools.push_back(&content::tool_of(assembly, joint));
        JointTrack track;
        track.result.id = joint.design.id;
        lesson.joints.push_back(std::move(track));
    }
    return lesson;
}

bool step_fulfilled(const Lesson& lesson, const world::ReadJoints& world) {
    const LessonStep* step = lesson.due();
    if (step == nullptr) return false;
    const JointTrack& track = lesson.joints[step->joint];
    const world::Joint& joint = world::joint_at(world, step->joint);
    switch (step->kind) {
        case StepKind::run_down:
            return joint.stage != joint::Stage::navigation;
        case StepKind::tighten:
            if (track.peak_torque < torque_window(lesson, *step).low) return false;
            if (requires_click(lesson, *step)) return track.clicked;
            return !requires_yield(lesson, *step) || track.yielded || track.clicked ||
                   track.peak_torque > spec_of(lesson, step->joint).torque.high;
        case StepKind::turn:
            return angle_from_mark(lesson, world, step->joint) >= angle_window(*lesson.assembly, *step).low;
        case StepKind::recheck:
            return joint.angle - track.begin_angle > recheck_turn ||
                   track.peak_torque >= torque_window(lesson, *step).low;
        case StepKind::loosen:
            return joint.stage == joint::Stage::navigation ||
                   (step->angle > 0.0 && track.begin_angle - joint.angle >= step->angle);
    }
    return false;
}

void observe(Lesson& lesson, const world::ReadHaptics& world) {
    const world::ToolState& tool = world.only<world::ToolState>();
    if (tick_of(world) == 1) begin_step(lesson, world);
    const bool other_grip = lesson.held_joint >= 0 && tool.grip != lesson.grip;
    if (lesson.held_joint >= 0 && (tool.joint != lesson.held_joint || other_grip)) release(lesson, world);
    if (tool.joint >= 0 && lesson.held_joint < 0) engage(lesson, tool.joint, tool.grip, world);
    if (lesson.held_joint >= 0) observe_work(lesson, static_cast<std::size_t>(lesson.held_joint), world);
    if (tool.slipped >= 0) {
        const auto joint = static_cast<std::size_t>(tool.slipped);
        const double rounded = joint_at(world, joint).rounded;
        ++lesson.joints[joint].slip_count;
        add_mistake(lesson, tick_of(world), MistakeKind::slipped, joint, rounded,
                    fmt::format("{}: the wrench slipped, {:.2f} mm of the {}'s corners are gone",
                                lesson.joints[joint].result.id, 1e3 * rounded,
                                fastener_name(lesson.assembly->joints[joint].design)));
    }
    end_assessment(lesson, world);
    // The step of a broken or stripped joint cannot be done; the lesson continues with the next one.
    const LessonStep* due = lesson.due();
    if (due != nullptr && lesson.held_joint < 0 &&
        lesson.joints[due->joint].result.condition != joint::JointCondition::intact)
        end_step(lesson, world);
}

bool undo_steps(Lesson& lesson, const world::ReadHaptics& world, std::size_t steps) {
    if (lesson.mode == Mode::assessment || steps > lesson.current) return false;
    const std::size_t to = lesson.current - steps;
    if (to >= lesson.step_starts.size()) return false;  // all steps are done, or none has begun
    if (lesson.held_joint >= 0) {
        const auto joint = static_cast<std::size_t>(lesson.held_joint);
        add_event(lesson, tick_of(world), EventKind::release, lesson.held_joint,
                  lesson.joints[joint].peak_torque, {});
        lesson.held_joint = -1;
        lesson.released_at = tick_of(world);
    }
    std::vector<JointTrack> tracks = lesson.step_starts[to];
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        tracks[i].result.done_already = lesson.joints[i].result.done_already;
        tracks[i].result.out_of_turn = lesson.joints[i].result.out_of_turn;
        tracks[i].wrong_way_count = lesson.joints[i].wrong_way_count;
        tracks[i].over_torque_count = lesson.joints[i].over_torque_count;
        tracks[i].over_turn_count = lesson.joints[i].over_turn_count;
        tracks[i].slip_count = lesson.joints[i].slip_count;
        tracks[i].common_turn_count = lesson.joints[i].common_turn_count;
        tracks[i].bent_count = lesson.joints[i].bent_count;
        tracks[i].result.condition = joint_at(world, i).condition;
    }
    lesson.joints = std::move(tracks);
    lesson.current = to;
    add_event(lesson, tick_of(world), EventKind::undo, static_cast<int>(lesson.steps[to].joint),
              static_cast<double>(steps), fmt::format("back to step {} of {}", to + 1, lesson.steps.size()));
    begin_step(lesson, world);
    return true;
}

}  // namespace bolt::lesson
