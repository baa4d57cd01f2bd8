// A hand controlled by a mouse. A press on a nut sends the hand there; the hand grips the nut or puts the
// wrench on it, turns the nut while the button is held, and lifts off on release. The hand plans by itself
// what a mouse cannot specify: a path around the casing, and the side from which the handle has room to
// swing. It has no clock and supplies the servo with poses like any other hand.
#pragma once

#include <optional>
#include <vector>

#include "game/lesson/lesson.hpp"
#include "game/world/world.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainer {

using world::HandAction;
using world::WorkingHand;

// Input of the mouse for one frame.
struct MouseCommand {
    std::optional<std::size_t> nut;  // pressed since the last frame
    bool take_wrench = false;        // a click on the wrench at rest, or Action::tool on the keyboard
    std::uint8_t tool = 0;           // index in servo::Setup::tools of the tool that an empty hand would take
    bool lay_down = false;
    bool retreat = false;  // move away from the nuts, with whatever the hand holds
    bool button_down = false;
    bool loosens = false;  // direction of the next pull; determines on which side the handle needs room
    double turn = 0.0;     // rad by which the handle was dragged since the last frame, tightening positive
    double spin = 0.0;     // −1 … 1, share of the fastest twist of the fingers, tightening positive
};

struct HelpedHand {
    HandAction action = HandAction::resting;
    bool wrench = false;             // in the hand
    std::uint8_t tool = 0;           // index of the tool in the hand, or ready for it
    bool changes_tool = false;       // at rest, and about to go to `nut` with another tool
    std::optional<std::size_t> nut;  // joint that the hand moves to, is at or holds
    Pose pose;                       // of the tool, in the assembly's frame
    Pose rest;                       // where the wrench lies; an empty hand waits beside it
    double trainee_side = -1.0;  // −1: the trainee stands on the −y side of `rest`; +1: on the +y side
    double handle_angle = 0.0;   // rad, about the bolt, tightening positive
    bool flipped = false;        // an open-end wrench is turned over
    double free_swing = 0.0;     // rad by which the handle can swing in this pull
    double hover_height = 0.0;   // m above the nut, where the hand waits

    double stroke_begin = 0.0;  // rad, handle angle at the start of the pull or twist
    double twist_end = 0.0;     // rad, handle angle at which the fingers start to return
    // From the command; `turn` is the part that is not yet executed. `button_down` also ends when the hand
    // gives up a nut that it could not engage.
    bool button_down = false, loosens = false;
    double turn = 0.0, spin = 0.0;
    // The present movement, and what the hand does when it arrives (OnArrival).
    Pose from, to;
    Vec3 bulge{0.0};              // m, deviation from the straight line at the middle (motion::arc_pose)
    std::vector<Pose> waypoints;  // to visit after `to`, last one first
    double elapsed = 0.0, duration = 0.0;  // s
    enum class OnArrival : std::uint8_t {
        rest,
        take,
        lay_down,
        lower,
        change_tool
    } on_arrival = OnArrival::rest;
    std::optional<std::size_t> queued_nut;  // pressed while the hand was busy
    bool missed = false;                    // the last attempt did not engage the nut, or lost it
    // Consecutive misses. Each of the first five raises the arc of the next reach by 5 cm; from the second on
    // the handle comes from another side.
    int misses = 0;
};

// A resting hand beside the wrench at `rest`, which must be the resting place for that side
// (scene::wrench_rest_pose).
HelpedHand make_hand(const Pose& rest, hand::Side side = hand::Side::right);

WorkingHand hand_of(const HelpedHand& hand);

// Call once a frame.
void apply_command(HelpedHand& hand, const MouseCommand& command, const servo::Setup& setup,
                   const servo::State& state);

// The pose in which a helped hand would put the wrench that lies at `rest` onto a nut now.
Pose wrench_pose_on_nut(const Pose& rest, const servo::Setup& setup, const servo::State& state,
                        std::size_t joint, bool loosens);

// Advances the hand by one tick and returns the servo's input, except `guided_joint` and `second_wrench`,
// which the caller sets, and the members that LessonSession::tick() sets.
servo::TickInput step_hand(HelpedHand& hand, const servo::Setup& setup, const servo::State& state);

}  // namespace bolt::trainer
