// The lesson: the state machine that follows the trainee through its steps. It observes the world after each
// servo tick, tracks the due step and reports mistakes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/plan.hpp"
#include "game/lesson/result.hpp"
#include "game/lesson/tool_choice.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::lesson {

// The record of one joint between ticks. A hold lasts from the tick in which the hand engages the nut until
// it releases the nut. The members whose comment names "this hold" are reset when a hold begins; `worked` is
// kept if fingers grip the same nut again within a second.
struct JointTrack {
    JointResult result;
    // rad, the nut angle from which the tightening angle counts: in a lesson that turns nuts by an angle, the
    // angle of the nut on its seat when its first step of kind `turn` began; else, or if it was not on its
    // seat then, the angle at which it reached the snug torque. None before that.
    std::optional<double> mark;
    double peak_torque = 0.0;    // N·m, since the last step of this joint began
    double turned_torque = 0.0;  // N·m, highest at which the nut turned, since it was last off its seat
    double begin_angle = 0.0;    // rad, nut angle when the step began
    bool yielded = false;        // the yield stage was reached
    bool clicked = false;        // the torque wrench clicked since the last step of this joint began
    bool worked = false;         // the hand has loaded or turned the nut in this hold
    double furthest = 0.0;       // rad, extreme nut angle of this hold: highest if tightening, else lowest
    bool seated = false;         // the nut was on its seat at `furthest`
    bool wrong_way_reported = false;    // in this hold
    int wrong_way_count = 0;            // holds in which it was turned the wrong way
    bool over_torque_reported = false;  // since the nut was last off its seat
    int over_torque_count = 0;          // undo keeps this and all other ..._count members
    bool over_turn_reported = false;    // since the nut was last off its seat
    int over_turn_count = 0;
    int slip_count = 0;
    double peak_at_grip = 0.0;          // N·m, peak_torque when this hold began
    double common_turn_at_grip = 0.0;   // rad, world::Joint::common_turn when this hold began
    double common_turn = 0.0;           // rad, at the last tick of this hold
    bool common_turn_reported = false;  // in this hold
    int common_turn_count = 0;
    double bent_at_grip = 0.0;   // rad, world::ToolState::bent when this hold began
    bool bend_reported = false;  // in this hold
    int bent_count = 0;
    int done_in_pass = -1;                          // last pass in which a step of this joint was done
    joint::Stage stage = joint::Stage::navigation;  // the last one that an event reported
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
    std::vector<const content::WrenchDesign*> tools;  // by joint, in `assembly`
    std::vector<ToolFault> tool_faults;               // by joint; replays of old sessions have none
    ToolFault reported_tool_fault =
        ToolFault::none;  // reported once a lesson: the trainee chooses the tool only once, before it begins
    int held_joint = -1;  // in the hand at the last tick; −1: none
    servo::Grip grip = servo::Grip::none;              // in the present or the last hold
    int last_held_joint = -1;                          // the joint that was released last
    std::uint64_t released_at = 0;                     // tick in which it was released
    int announced_pass = -1;                           // latest pass with a pass_begin event
    std::vector<std::vector<JointTrack>> step_starts;  // by step: all tracks at its start, for undo_steps()
    std::vector<LessonEvent> events;                   // pending: the caller clears them

    [[nodiscard]] const LessonStep* due() const { return current < steps.size() ? &steps[current] : nullptr; }
};

// `assembly` must outlive the lesson.
Lesson begin(const content::Assembly& assembly, Mode mode, Task task);

// A step is due until it is done. The hand may leave the nut in between (an open-end wrench comes off for
// each stroke). A step is done when the hand releases a nut that meets the step's condition:
//   run down    the nut is on its seat
//   tighten     the torque reached the low edge of the step's window. A step to the whole target of a
//               joint with Strategy::yield also needs one of: the joint yields, the torque exceeds its
//               window, the torque wrench clicks. Some steps need the click (requires_click)
//   turn        the nut was turned from its mark by at least the low edge of the step's angle window
//   re-check    the wrench turned the nut further, or reached the window without turning it
//   loosen      the nut was turned back by the step's angle, or is free of clamp force
// In assessment, work on the next step's joint ends the due step, fulfilled or not, once the due joint has
// been loaded. The last step of an assessment ends some time after the hand has released its joint. In other
// modes the step stays due. In all modes the step of a broken or stripped joint ends as soon as no nut is
// held.
//
// True if releasing the nut now completes the due step.
bool step_fulfilled(const Lesson& lesson, const world::ReadJoints& world);

// Call after each tick, once world::write_haptics() has written its results into the world.
void observe(Lesson& lesson, const world::ReadHaptics& world);

// Undoes `steps` steps; 0 restarts the due step. Restores the joint tracks at that step's start; the caller
// has already restored the joints of the servo and the world. Mistakes stay counted, and a held nut is
// released. Returns false, without a change, in assessment or if there is no such step.
bool undo_steps(Lesson& lesson, const world::ReadHaptics& world, std::size_t steps);

}  // namespace bolt::lesson
