// Plans a lesson: a list of steps, made from the assembly's passes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::lesson {

enum class Mode : std::uint8_t { guided, practice, assessment };
enum class Task : std::uint8_t { tighten, loosen };
enum class StepKind : std::uint8_t { run_down, tighten, recheck, loosen };

constexpr std::string_view name(Mode mode) {
    constexpr std::string_view names[] = {"guided", "practice", "assessment"};
    return names[static_cast<int>(mode)];
}

constexpr std::string_view name(Task task) { return task == Task::tighten ? "tighten" : "loosen"; }

constexpr std::string_view name(StepKind kind) {
    constexpr std::string_view names[] = {"run down by hand", "tighten", "re-check", "loosen"};
    return names[static_cast<int>(kind)];
}

struct Step {
    StepKind kind = StepKind::tighten;
    std::size_t joint = 0;
    double torque = 0.0;    // N·m to reach; tighten and recheck
    double fraction = 1.0;  // of the joint's target
    int pass = 0;
};

// The assembly with `law` in force, its specifications adapted to it. The specifications of joint types hold
// under the mechanistic law. Under the published law every joint ends at the same T_max, whatever its
// fastener is: the assembly's own published targets replace them; without any, targets above 98 % of T_max
// are lowered to that. No angle is judged, and the target clamp force follows from the target torque.
// Applying a law twice changes nothing more.
content::Assembly under_law(content::Assembly assembly, joint::Law law);

// Tightening: the assembly's passes in order. Loosening: every joint once, in the reverse of the last pass's
// order.
std::vector<Step> make_plan(const content::Assembly& assembly, Task task);

// Whether fingers do the step: running down a nut whose drag is small against `finger_torque`, the torque
// that fingers can apply, N·m.
bool by_fingers(const content::Assembly& assembly, const Step& step, double finger_torque);

// The lesson: a state machine that observes servo ticks, tracks the due step, and judges the result.
//
// A step is due until it is done. The hand may leave the nut in between (an open-end wrench comes off for
// each stroke). A step is done when the hand releases a nut that meets the step's condition:
//   run down    the fingers have turned the nut onto its seat
//   tighten     the torque reached the low edge of the step's window. A full step with strategy `yield` also
//               needs the joint to yield, the torque to exceed its window, or the torque wrench to click
//   re-check    the wrench turned the nut further, or reached the window without turning it
//   loosen      the nut is free of clamp force
// In assessment, starting on the next joint ends the step in whatever state it is; in other modes the step
// stays due.

// State of a joint that the lesson keeps between ticks.
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

// The torque window of a step: the joint's window, scaled by the fraction of the pass.
content::Window window(const Lesson& lesson, const Step& step);

// Whether the step needs the bolt to yield.
bool into_yield(const Lesson& lesson, const Step& step);

// Set torque of the torque wrench for the due step, N·m; 0 for other tools and for steps without a torque.
double setting(const Lesson& lesson);

// Whether the due step will be done when the hand releases the nut.
bool reached(const Lesson& lesson, std::span<const joint::JointState> joints);
bool reached(const Lesson& lesson, const ecs::Access<const world::Joint>& joints);

// Call after each tick.
void observe(Lesson& lesson, const servo::State& state, const servo::Output& output);

// Goes back by `steps` steps; 0 restarts the due step. Restores the joint tracks of that step's start; the
// caller has already restored the joints in `state`. Mistakes stay counted, and a held nut is released.
// False, without a change, in assessment or if there is no such step.
bool back(Lesson& lesson, const servo::State& state, std::size_t steps);

// judge_joint(): the current result of one joint. judge(): that of the lesson, with score and reasons. `dt`:
// s.
JointResult judge_joint(const Lesson& lesson, std::size_t joint, const servo::State& state);
LessonResult judge(const Lesson& lesson, const servo::State& state, double dt);

}  // namespace bolt::lesson
