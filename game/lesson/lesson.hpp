// The lesson as a small state machine beside the servo: it watches ticks, knows which step is due, and
// judges.
//
// A step is due until it is done. The hand may come and go (an open-end wrench comes off for every stroke); a
// step is done when the hand has let go of a nut on which it reached what the step asks for:
//   run down    the fingers have turned the nut onto its seat
//   tighten     the torque reached the low edge of the step's window; in full and by strategy `yield` also
//   the joint
//               yielded (or the torque is past its window: more of it would not help; or a torque wrench
//               clicked)
//   re-check    the wrench moved the nut on, or reached the window without moving it
//   loosen      the nut is free of clamp force
// In assessment a joint that is left for the next one counts as done as it was left; in the other modes the
// step stays.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/plan.hpp"
#include "game/lesson/result.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::lesson {

// What the lesson remembers of a joint between ticks.
struct JointTrack {
    JointResult result;
    bool snug = false;           // the snug torque has been reached
    double snug_angle = 0.0;     // rad, nut angle when it was reached first
    double peak_torque = 0.0;    // N·m, of the step that is due
    double turned_torque = 0.0;  // N·m, highest with which the nut turned on since it was last off its seat
    double begin_angle = 0.0;    // rad, nut angle when the step began
    bool yielded = false;        // the yield stage has been felt
    bool clicked = false;        // the torque wrench did, in the step that is due
    bool worked = false;         // the hand has done something with the nut in this visit
    double furthest = 0.0;  // rad, nut angle, of this visit: the highest, in a lesson that loosens the lowest
    bool seated = false;    // the nut was on its seat there
    bool turned_back = false;           // from there, and that was said
    int wrong_ways = 0;                 // visits in which it was turned back
    bool overdone = false;              // more than its window was said, since it was last off its seat
    int times_overdone = 0, slips = 0;  // in all, also what was taken back
    int done_in_pass = -1;              // last pass in which a step of this joint was done
    joint::Stage stage = joint::Stage::navigation;
};

struct Lesson {
    const content::Assembly* assembly = nullptr;
    Mode mode = Mode::guided;
    Task task = Task::tighten;
    bool guides = true;  // a force leads the hand to the due joint; begin(): in guided lessons
    std::vector<Step> steps;
    std::size_t current = 0;
    std::vector<JointTrack> joints;
    int held = -1;  // joint in the hand at the last tick
    servo::Grip grip = servo::Grip::none;
    int left = -1;                               // joint that was in the hand last
    std::uint64_t released_at = 0;               // tick
    int announced = -1;                          // pass that was announced last
    std::vector<std::vector<JointTrack>> begun;  // by step: all tracks when it began, for back()
    std::vector<Event> events;                   // since they were last taken

    [[nodiscard]] const Step* due() const { return current < steps.size() ? &steps[current] : nullptr; }
};

// `assembly` must outlive the lesson.
Lesson begin(const content::Assembly& assembly, Mode mode, Task task);

// What the torque of a step is to be: the joint's window, scaled to the pass's share.
content::Window window(const Lesson& lesson, const Step& step);

// Whether the step goes on until the bolt begins to yield.
bool into_yield(const Lesson& lesson, const Step& step);

// What a torque wrench is set to for the due step, N·m; 0: the tool is none, or there is nothing to set.
double setting(const Lesson& lesson);

// Whether the due step is done as soon as the hand lets go.
bool reached(const Lesson& lesson, std::span<const joint::JointState> joints);

// After each tick.
void observe(Lesson& lesson, const servo::State& state, const servo::Output& output);

// Makes the step before the due one due again, `steps` of them; 0: begins the due one anew. What was noted of
// the joints is as it was when that step began, and `state` is to be so too: whoever calls this has put the
// joints back. Mistakes stay counted. A nut in the hand is let go of. False, and nothing changes: in
// assessment, and where there is no such step.
bool back(Lesson& lesson, const servo::State& state, std::size_t steps);

// The state of one joint's result now, with verdicts; and of the whole, with the score and its reasons.
JointResult judge_joint(const Lesson& lesson, std::size_t joint, const servo::State& state);
LessonResult judge(const Lesson& lesson, const servo::State& state, double dt);

}  // namespace bolt::lesson
