// Behaviour of a simulated trainee: its state between ticks, and the movements of its hand (reach, pull,
// spin).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/random.hpp"
#include "game/lesson/lesson.hpp"
#include "game/lesson/step_requirements.hpp"
#include "game/motion/path_planning.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/trainees/human_model.hpp"
#include "game/trainees/step_plan.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainees {

// Action of the hand. At its end each phase selects the next one.
enum class Phase {
    pause,        // hesitates, then chooses the next action
    search_view,  // moves its head until enough of the nut is visible
    change_tool,  // moves to the rest pose to put down or pick up the wrench
    reach,        // moves above the nut
    lower,        // lowers the tool onto the nut
    engage,       // waits until the jaw or the fingers hold the nut
    pull,         // turns the nut with the wrench
    unload,       // lets the wrench spring back
    swing_back,   // swings a ratchet back for the next pull
    lift,         // lifts the tool off the nut
    spin,         // turns the nut with the fingers
    spin_back,    // opens the fingers and turns the hand back
    done
};

// The state of a simulated trainee between ticks, with pointers to the simulation's state of this tick.
struct TraineeState {
    TraineeProfile profile;
    Random random;
    motion::Tremor tremor;
    DelayedPerception perception;
    StepPlan plan;
    Phase phase = Phase::pause;
    double time = 0.0;                 // s since the beginning of the lesson
    double phase_start = 0.0;          // s
    double phase_duration = 0.0;       // s; 0: the phase has no fixed duration
    Pose from, to;                     // of the current movement
    bool flipped = false;              // an open-end wrench is turned over
    double handle_angle = 0.0;         // rad about the bolt
    double stroke_start = 0.0;         // rad, handle angle at the start of the stroke
    double stroke_end = 0.0;           // rad, from which a ratchet swings back
    double nut_angle_at_stroke = 0.0;  // rad, at the start of the stroke
    double stroke_turn = 0.0;          // rad by which the last stroke turned the nut; negative: loosened it
    int fruitless_strokes = 0;         // consecutive strokes that neither turned nor tightened the nut

    double nut_angle_at_start = 0.0;  // rad, angle of the due nut when the plan was made
    double free_turn = 0.0;           // rad turned without resistance while loosening
    bool nut_follows_back = false;    // in this step a ratchet that swung back took the nut along
    Vec3 placement_error{0.0};        // m, offset of the placed tool from the nut's centre
    Vec3 bulge{0.0};                  // m, deviation of the reach from the straight line at its middle
    std::vector<Pose> waypoints;      // after `to`, in reverse order
    double free_swing = 0.0;          // rad that the handle can swing in this stroke
    double hover_height = 0.0;        // m above the nut, start of the lowering

    bool holds_wrench = false;
    std::uint8_t tool = 0;            // index of the tool in use or needed next (servo::TickInput::tool)
    std::int16_t second_wrench = -1;  // joint on which it has put the second wrench; −1: none
    double last_common_turn = 0.0;    // rad, joint::JointState::common_turn when it was last seen
    double seen_common_turn = 0.0;    // rad, sum of its changes in the pulls of this step
    double caught_time = 0.0;         // s for which an obstacle has held the wrench back
    int consecutive_catches = 0;      // retreats from an obstacle in a row
    int consecutive_misses = 0;       // attempts in a row in which the jaw did not slide onto the nut
    motion::VisibilityModel visibility;
    motion::ViewHelper view_help;
    Vec3 next_eye{0.0};                       // m, target of the head's movement
    std::vector<lesson::LessonEvent> events;  // since the last SimulatedTrainee::take_events
    double reported_visibility = -1.0;        // 0…1, the value of the last event
    std::size_t reported_joint = SIZE_MAX;    // the joint of the last event
    HandDeflection deflection;
    double arm_lag = 0.0;               // s by which a force-feedback arm lags behind the hand
    Pose hand;                          // actual pose of the hand
    bool held_nut = false;              // held a nut in the last tick
    bool intended_pose_jumped = false;  // the intended pose jumps in this tick; the hand keeps its pose
    Pose rest;                          // of the tool, in front of the assembly, clear of obstacles

    // The simulation's state of this tick.
    const servo::Setup* setup = nullptr;
    const servo::State* servo_state = nullptr;
    const lesson::Lesson* lesson = nullptr;

    TraineeState(const TraineeProfile& p, std::uint64_t seed, const servo::Setup& s)
        : profile(p), random(seed, 7001), tremor(random), perception(p.reaction, s.dt, s.wrench.stiffness) {}

    [[nodiscard]] const servo::NutGeometry& nut() const { return setup->nuts[plan.joint]; }
    [[nodiscard]] const joint::JointState& joint() const { return servo_state->joints[plan.joint]; }
    // Null without contact simulation.
    [[nodiscard]] const servo::ToolContact* obstacles() const {
        return servo_state->tool_contact ? &*servo_state->tool_contact : nullptr;
    }
    [[nodiscard]] double elapsed() const { return time - phase_start; }
    [[nodiscard]] double progress() const { return phase_duration > 0.0 ? elapsed() / phase_duration : 1.0; }
    // True if a second wrench must hold the held part of the joint and does not.
    [[nodiscard]] bool lacks_second_wrench() const {
        return !plan.fingers && lesson::needs_second_wrench(*lesson->assembly, plan.joint) &&
               second_wrench != static_cast<int>(plan.joint);
    }
    [[nodiscard]] bool phase_over() const { return progress() >= 1.0; }
    [[nodiscard]] bool step_is_past() const { return plan.step != lesson->current; }
    [[nodiscard]] bool holds_intended_nut() const {
        return servo_state->engagement.joint == static_cast<int>(plan.joint);
    }
    [[nodiscard]] Vec3 random_offset(double deviation) { return normal_vector(random) * deviation; }

    void enter(Phase next, double seconds = 0.0) {
        phase = next;
        phase_start = time;
        phase_duration = seconds;
    }

    // Pose of the tool at `height` (m) above its seat on the intended nut.
    [[nodiscard]] Pose tool_at_nut(double height) const {
        return {servo::nut_centre(nut(), joint().nut.angle) + nut().axis * height + placement_error,
                motion::tool_orientation(nut(), handle_angle, flipped)};
    }
};

// Height of the tool above the nut before lowering and after lifting, m. It clears the bolt's end, even while
// a force of a few newtons draws the hand down.
constexpr double default_hover = 0.035;

// Chooses the due step and the plan for it, and starts the first movement.
void begin_next_action(TraineeState& t);

// Chooses the handle angle so that the stroke is centred on the trainee's side; after repeated failures, on a
// random side.
void choose_handle_angle(TraineeState& t);

// Moves the head to next_eye and starts the reach to the nut.
void start_reach(TraineeState& t);

// Called at the end of a movement. Starts the movement to the next waypoint in the phase `phase`; returns
// false if there is none.
bool start_next_waypoint(TraineeState& t, Phase phase);

void start_lift(TraineeState& t, const Pose& pose, double seconds);

// Call it when the tool engages the nut. Sets the intended pose to the hand's actual pose, except along the
// bolt, where the tool still has to slide on.
void adopt_wrench_pose(TraineeState& t);

// The direction, not normalised, in which a caught tool retreats at the given number of catches in a row.
// `up`: unit, off the nearest nut; `back`: to the rest pose; `aside`: from the intended pose to the tool. Odd
// retreats go up and back, even ones sideways, because a corner that is hooked in a thread does not come out
// along the bolt. Each of them has a part along `up`.
Vec3 retreat_direction(int catches, const Vec3& up, Vec3 back, Vec3 aside);

// Moves a wrench that is caught on an obstacle away from it. The next path is higher.
void retreat_if_caught(TraineeState& t, const Pose& intended, const Pose& wrench);

// Each of these advances a phase by one tick and enters the next phase at its end. The torque of a pull grows
// at the trainee's rate until the felt torque reaches the goal or there is no more room to swing the wrench.
// A spin is one twist of the fingers.
void pull(TraineeState& t, const Percept& felt);
void spin(TraineeState& t, const Percept& felt);

// These move the handle by one tick; the caller ends the phase. The wrench springs back before it is lifted;
// a ratchet swings back on the nut, and the open fingers turn back for the next twist.
void unload(TraineeState& t);
void swing_back(TraineeState& t);
void spin_back(TraineeState& t);

// Puts the second wrench on plan.joint once the trainee sees that nut and bolt turn together; motions in both
// directions add up.
void notice_common_turn(TraineeState& t);
// Returns true if a ratchet can pull again without leaving the nut.
bool pulls_again(const TraineeState& t);
// At the end of a swing back: ends the plan if the ratchet has taken the nut back with it.
void notice_free_nut(TraineeState& t);

}  // namespace bolt::trainees
