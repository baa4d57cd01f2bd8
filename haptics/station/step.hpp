// One tick of a station: what its devices told becomes the servo's input, what the servo puts out becomes
// what the devices are to render. Pure, of fixed dt, without allocation, lock, clock or I/O. Forces come from
// the servo's output stage only; here they are mapped and made less.
//
// A device that is lost, or silent for longer than it may be, moves nothing and gets no force; when it is
// back the hand may be anywhere, so the tool stays where it is and follows from there, as after a clutch.
#pragma once

#include <limits>

#include "haptics/device/line.hpp"
#include "haptics/servo/tick.hpp"
#include "haptics/station/layout.hpp"

namespace bolt::station {

// What devices do not tell: a lesson's, a glove's, a keyboard's.
struct Wishes {
    servo::Grip grip = servo::Grip::none;  // `wrench` counts where there is no gloved hand
    bool held = false;                     // the dead-man, besides the devices' buttons
    // s for which that is believed without a new wish: a window that hangs holds nothing.
    double lasts = std::numeric_limits<double>::infinity();
    bool clutch = false, stop = false, reset = false;
    std::int16_t guide = -1;
    float setting = 0.0F;  // N·m, of a wrench that clicks
    // How whoever pushes looks at it: what they push goes by their right, up and nearer to them.
    Quat looks{1.0, 0.0, 0.0, 0.0};
    // Nobody works: no servo tick, no force, and the tool stays where it is while the hand goes where it
    // likes.
    bool pause = false;
    // Where the wrench lies while it is in no hand; none: it comes along in the open one.
    std::optional<Pose> rest{};
    // Of a gloved hand that holds nothing, and whose fingertips are what the device moves: its wrist in their
    // frame; none: it is moved as if it held the tool.
    std::optional<Pose> bare_wrist{};
    // Joint whose nut draws the tool of a hand that only pushes it and feels nothing; −1: none. Such a tool
    // glides there by itself, as a guiding force would lead a hand.

    std::int16_t glide = -1;
    // The tool goes there, the hand stays where it is. Done once for every other number.
    Pose put{};
    std::uint32_t put_number = 0;
    // How many marks of the nuts are to have been kept by now (servo::keep_mark), one a tick.
    std::uint32_t marks = 0;
    // What servo::Input::undo is to ask for until it is granted; once granted, not again for this number.
    std::uint8_t back = 0;
    std::uint32_t back_number = 0;
};

struct Heard {
    device::Told mover, wheel;
    Wishes wishes;
    double age = 0.0;  // s, of the wishes

    std::optional<servo::Grip> hand;  // of the gloved hand, if there is one
    std::uint64_t missed = 0;         // deadlines of the servo without a tick since the one before
};

// What is known of one device.
struct Port {
    std::uint64_t number = 0, opening = 0;  // of its last sample
    double quiet = 0.0;                     // s since that
    bool fresh = false;                     // it told something in this tick
    bool usable = false;
    double share = 0.0;  // 0 … 1 of the force that it gets
};

struct State {
    Port mover, wheel;
    force::WorkspaceState workspace;  // `tool` is where the hand has it
    Pose hand;                        // of the mover, its frame
    double turn = 0.0;                // rad, of the wheel
    Vec3 axis{0.0, 1.0, 0.0};         // of the bolt that the wheel turns, or turned last
    double on_bolt = 0.0;             // 0 … 1: the wheel feels that bolt
    bool anew = false;                // the servo hung: no force until the output stage has let go too
    std::optional<Pose> lies;  // where the wrench is while it is in no hand, where Wishes::rest lets it lie
    force::GuideState glides;
    int carried_by = -1;  // nut that a pushed tool goes along with
    Vec3 carried_at{0.0};
    std::uint32_t put_number = 0, marks = 0, back_number = 0;  // of what was wished and is done
    std::uint32_t back_wished = 0;
    bool stopped = false;  // the stop was pressed in a pause: it counts after that
    bool pressed = false;  // a device's button that closes the hand: the dead-man's
    servo::Input input;    // of the last tick
    servo::Output output;
};

struct Answer {
    force::OutputCommand mover, wheel;  // each in its device's frame
};

State initial_state(const Layout& layout);

Answer tick(const Layout& layout, const servo::Setup& setup, State& state, servo::State& servo,
            const Heard& heard);

// The two halves of it.
servo::Input hear(const Layout& layout, const servo::Setup& setup, State& state, const Heard& heard);
// How a tool that is only pushed goes on by itself: after hear(), for the tick that follows.
void glide(const Layout& layout, const servo::Setup& setup, State& state, const servo::State& servo,
           const Heard& heard, servo::Input& input);
Answer answer(const Layout& layout, const servo::Setup& setup, State& state, const servo::Output& output);

// Where a gloved hand would have the tool, were it in it (ToolPlace::wished). A bare one that comes near the
// wrench lies at its handle: nobody can fit fingers around it to the millimetre with a hand that they only
// see.
Pose in_hand(const Layout& layout, const servo::Setup& setup, const State& state, const Wishes& wishes);
inline constexpr double at_handle = 0.10;  // m, from its middle line to the fingertips

// Instead of a tick while Wishes::pause is wished: devices are listened to, and get no force; that comes back
// slowly.
Answer pause(const Layout& layout, const servo::Setup& setup, State& state, const Heard& heard);

// A puck's tool may be ahead of what obstacles allow by so much: it turns back at once.
inline constexpr double ahead = 0.01, turned_ahead = 0.15;  // m, rad
// Chosen: a pushed tool spins a nut so many times faster than it turns otherwise; under the greatest torque
// it turns so many times more slowly, but one.
inline constexpr double spinning = 4.0, firmness = 15.0;
// A rate is believed for so long without a new one.
inline constexpr double rate_lasts = 0.25;  // s

}  // namespace bolt::station
