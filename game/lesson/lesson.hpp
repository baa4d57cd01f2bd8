// The lesson: its steps, planned from the assembly's passes, and the state machine that follows the trainee
// through them. It observes the world after each servo tick, tracks the due step and judges the result.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/lesson/tool_choice.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::lesson {

enum class StepKind : std::uint8_t { run_down, tighten, turn, recheck, loosen };

inline constexpr EnumNames<StepKind, 5> step_kind_names{
    {"run down by hand", "tighten", "turn", "re-check", "loosen"}};
constexpr std::string_view name(StepKind kind) { return step_kind_names.of(kind); }

struct LessonStep {
    StepKind kind = StepKind::tighten;
    std::size_t joint = 0;
    // N·m to reach; tighten and recheck. turn: the joint's target torque, which does not end the step.
    double torque = 0.0;
    double fraction = 1.0;  // of the joint's target
    int pass = 0;
    // rad. turn: the angle to reach, counted from the mark. loosen: the angle to turn back; 0: until the nut
    // is free.
    double angle = 0.0;
};

// The adaptation of an assembly to the published law: the current one, and that of sessions before format 6,
// which their replays and reports need.
enum class LawAdaptation : std::uint8_t { yield_end, before_format_6 };

// Returns the assembly with `law` in force and its specifications adapted to it. The specifications of joint
// types hold under the mechanistic law. Under the published law the torque of a joint stops growing at its
// T_max (haptics/joint/published.hpp), so these targets replace them:
//   - the joint's own published targets, if the file has them
//   - otherwise targets in the last third of the yield stage, and an angle window, because the torque cannot
//   be too high: its upper limit lies beyond the end of the yield stage by a third of the stage's width
// A torque wrench is set so low that it clicks before the end of the yield stage, whatever its deviation. If
// that lowers the target torque, the lower torque limit stays below the lowest torque at which the wrench can
// click. The target clamp force follows from the target torque. Without θ_max in the file, θ_max is computed
// for a nut that starts at design.start_gap. `before_format_6`: without own targets, torques above 98 % of
// T_max are lowered to 98 %; no angle is judged; θ_max and the torque wrench are not adapted. Idempotent.
content::Assembly apply_law(content::Assembly assembly, joint::Law law,
                            LawAdaptation adaptation = LawAdaptation::yield_end);

// The passes of a loosening lesson: the file's, else one that loosens every joint, in the reverse order of
// the last pass.
std::vector<content::Pass> loosening_passes(const content::Assembly& assembly);

// The steps of a lesson, from the passes in their order.
std::vector<LessonStep> make_plan(const content::Assembly& assembly, Task task);

// True if a pass turns the joints by an angle; the angle of each joint then counts from a mark.
bool turns_by_angle(const content::Assembly& assembly);

// True if the step is done by fingers: it runs down a nut whose drag at `nut_angle` (rad) is small compared
// with the torque that fingers can apply. A locking nut is run down by fingers until the bolt's end reaches
// its insert, and then by the tool.
bool uses_fingers(const content::Assembly& assembly, const servo::Setup& setup, const LessonStep& step,
                  double nut_angle);

// The record of one joint between ticks. A hold lasts from the tick in which the hand engages the nut until
// it releases it; an analysis::Visit may have several. The members whose comment names "this hold" are reset
// when a hold begins, except `worked` if fingers grip the same nut again within a second.
struct JointTrack {
    JointResult result;
    // The nut angle from which the tightening angle counts, rad: where the snug torque was reached first or,
    // in a lesson that turns nuts by an angle, where the nut rested when its first step of kind `turn` began.
    bool snug = false;  // there is such an angle
    double snug_angle = 0.0;
    double peak_torque = 0.0;    // N·m, since the last step of this joint began
    double turned_torque = 0.0;  // N·m, highest at which the nut turned, since it was last off its seat
    double begin_angle = 0.0;    // rad, nut angle when the step began
    bool yielded = false;        // the yield stage was reached
    bool clicked = false;        // the torque wrench clicked in the due step
    bool worked = false;         // the hand has loaded or turned the nut in this hold
    double furthest = 0.0;       // rad, extreme nut angle of this hold: highest if tightening, else lowest
    bool seated = false;         // the nut was on its seat at `furthest`
    bool turned_back = false;    // turning the wrong way was reported in this hold
    int wrong_way_count = 0;     // holds in which it was turned the wrong way
    bool over_torqued = false;   // excess torque was reported since the nut was last off its seat
    int over_torque_count = 0;   // undo reduces neither this nor the following counts nor wrong_way_count
    bool over_turned = false;    // an excess angle was reported since the nut was last off its seat
    int over_turn_count = 0;
    int slip_count = 0;
    double peak_at_grip = 0.0;          // N·m, peak_torque when this hold began
    double common_turn_at_grip = 0.0;   // rad, world::Joint::common_turn when this hold began
    double common_turn = 0.0;           // rad, at the last tick of this hold
    bool common_turn_reported = false;  // in this hold
    int common_turn_count = 0;
    double bent = 0.0;           // rad, world::ToolState::bent when this hold began
    bool bend_reported = false;  // in this hold
    int bent_count = 0;
    int done_in_pass = -1;  // last pass in which a step of this joint was done
    joint::Stage stage = joint::Stage::navigation;
};

struct Lesson {
    const content::Assembly* assembly = nullptr;
    Mode mode = Mode::guided;
    Task task = Task::tighten;
    bool guides = true;           // a force guides the hand to the due joint; begin() sets it in guided mode
    bool turns_by_angle = false;  // there are steps of kind `turn`
    std::vector<LessonStep> steps;
    std::size_t current = 0;  // index of the due step
    std::vector<JointTrack> joints;
    std::vector<ToolFault> tool_faults;               // by joint; replays of old sessions have none
    ToolFault reported_tool_fault = ToolFault::none;  // at most one a lesson, because the choice is one
    int held_joint = -1;                              // in the hand at the last tick; −1: none
    servo::Grip grip = servo::Grip::none;
    int last_held_joint = -1;                          // the joint that was released last
    std::uint64_t released_at = 0;                     // tick
    int announced_pass = -1;                           // latest pass with a pass_begin event
    std::vector<std::vector<JointTrack>> step_starts;  // by step: all tracks at its start, for undo_steps()
    std::vector<LessonEvent> events;                   // pending: the caller clears them

    [[nodiscard]] const LessonStep* due() const { return current < steps.size() ? &steps[current] : nullptr; }
};

// `assembly` must outlive the lesson.
Lesson begin(const content::Assembly& assembly, Mode mode, Task task);

// The torque window of a step: the joint's window, scaled by the fraction of the pass.
content::ToleranceWindow torque_window(const Lesson& lesson, const LessonStep& step);

// The angle window of a step of kind `turn`, rad from the mark: the joint's window, scaled like the torque's.
content::ToleranceWindow angle_window(const content::Assembly& assembly, const LessonStep& step);

// The angle, rad, by which the nut has been turned from the mark, or 0 without a mark.
double angle_from_mark(const Lesson& lesson, const world::ReadJoints& world, std::size_t joint);

// True if the step tightens to the whole target with strategy `yield`.
bool requires_yield(const Lesson& lesson, const LessonStep& step);

// True if a second wrench must hold the other part of the joint while a tool turns it.
bool needs_second_wrench(const content::Assembly& assembly, std::size_t joint);
bool needs_second_wrench(const content::Assembly& assembly);  // any of its joints

// True if only the click of the torque wrench ends the step. This is so under the published law: there the
// torque grows so slowly in the yield stage that a stroke can end inside the torque window before the click.
// False if a wrench within its tolerance might not click at this set torque (sessions before format 6).
bool requires_click(const Lesson& lesson, const LessonStep& step);

// Set torque of the torque wrench for the due step, N·m on its scale (content::adaptor_ratio); 0 for other
// tools and for steps without a torque.
double wrench_set_torque(const Lesson& lesson);

// A step is due until it is done. The hand may leave the nut in between (an open-end wrench comes off for
// each stroke). A step is done when the hand releases a nut that meets the step's condition:
//   run down    the nut is on its seat
//   tighten     the torque reached the low edge of the step's window. A step to the whole target with
//               strategy `yield` also needs one of: the joint yields, the torque exceeds its window, the
//               torque wrench clicks. Some steps need the click (requires_click)
//   turn        the nut was turned from its mark by at least the low edge of the step's angle window
//   re-check    the wrench turned the nut further, or reached the window without turning it
//   loosen      the nut was turned back by the step's angle, or is free of clamp force
// In assessment, work on the next step's joint ends the due step, fulfilled or not, once the due joint has
// been loaded. In other modes the step stays due.
//
// True if releasing the nut now completes the due step.
bool step_fulfilled(const Lesson& lesson, const world::ReadJoints& world);

// Call after each tick, once world::write_haptics() has written its results into the world.
void observe(Lesson& lesson, const world::ReadHaptics& world);

// Undoes `steps` steps; 0 restarts the due step. Restores the joint tracks at that step's start; the caller
// has already restored the joints of the servo and the world. Mistakes stay counted, and a held nut is
// released. Returns false, without a change, in assessment or if there is no such step.
bool undo_steps(Lesson& lesson, const world::ReadHaptics& world, std::size_t steps);

// The display of an electronic torque wrench shows the torque on the nut, N·m on the scale of the wrench. In
// a step of kind `turn` it shows the angle from the mark, degrees. `target` refers to the window of the due
// step.
struct ToolReading {
    double value = 0.0;
    world::TargetState target = world::TargetState::below;
};
ToolReading tool_reading(const Lesson& lesson, const world::ReadHaptics& world);

// The current result of one joint.
JointResult judge_joint(const Lesson& lesson, std::size_t joint, const world::ReadJoints& world);
// The current result of the lesson, with score and reasons. `dt`: tick length, s.
LessonResult judge(const Lesson& lesson, const world::ReadHaptics& world, double dt);

}  // namespace bolt::lesson
