// One tick of a station: maps the devices' samples and the application's controls to the servo's input, and
// the servo's output to the devices' commands. Pure, of fixed dt, without allocation, lock, clock or I/O.
// Forces come from the servo's output stage; this code maps them and may only reduce them.
//
// A device that is lost or silent for too long moves nothing and renders no force. When it returns, the hand
// may be anywhere, so the tool stays in place and follows from there, as after a clutch.
#pragma once

#include <span>

#include "haptics/device/device_thread.hpp"
#include "haptics/servo/tick.hpp"
#include "haptics/station/commands.hpp"
#include "haptics/station/layout.hpp"

namespace bolt::station {

struct StationInputs {
    device::DeviceSnapshot mover, wheel;
    StationControls controls;
    double controls_age = 0.0;                   // s since the controls were sent
    std::span<const StationCommand> commands{};  // received since the last tick, in order
    std::optional<servo::Grip> hand_grip;        // of a gloved hand; none: no gloved hand
    std::uint64_t missed = 0;                    // deadlines of the servo without a tick since the last tick
};

// The state of the connection to one device.
struct DeviceLink {
    std::uint64_t number = 0,
                  opening = 0;  // of the last sample; `opening` counts how often the device was opened
    double silence = 0.0;       // s since the last sample
    bool fresh = false;         // a sample arrived in this tick
    bool usable = false;
    double force_share = 0.0;  // 0 … 1, share of the force that the device renders
};

struct State {
    DeviceLink mover, wheel;
    force::WorkspaceState workspace;  // `tool` is the pose commanded by the hand
    Pose hand;                        // last pose of the mover, in its frame
    double wheel_angle = 0.0;         // rad, last sample of the wheel
    Vec3 bolt_axis{0.0, 1.0, 0.0};    // unit, of the bolt that the wheel turns or turned last
    double wheel_fade = 0.0;          // 0 … 1, share of the bolt's torque that the wheel renders
    bool restarting = false;          // after a stall or a pause: no force until the output stage is at zero
    std::optional<Pose>
        wrench_rest;  // pose of the wrench while no hand holds it; needs StationControls::wrench_rest
    force::GuideState glides;
    int carrying_joint = -1;   // joint whose nut carries a pushed tool along; −1: none
    Vec3 carrying_point{0.0};  // m, centre of that nut at the last tick
    // Commands received and not executed yet.
    std::optional<Pose> tool_to_place;
    std::uint32_t checkpoints_to_save = 0;
    std::uint8_t checkpoint_to_restore = 0;  // 0: none
    bool stopped_in_pause = false;           // a stop pressed in a pause takes effect afterwards
    bool dead_man_pressed = false;           // by a button of a device, in this tick
    servo::Input input;                      // of the last tick
    servo::Output output;
};

struct DeviceCommands {
    force::OutputCommand mover, wheel;  // each in its device's frame
};

State initial_state(const Layout& layout);

DeviceCommands tick(const Layout& layout, const servo::Setup& setup, State& state, servo::State& servo,
                    const StationInputs& inputs);

// The parts of tick(), in order.
servo::Input read_inputs(const Layout& layout, const servo::Setup& setup, State& state,
                         const StationInputs& inputs);
// Moves a tool whose device gives rates and renders no force: along with a held nut, and towards
// StationControls::glide. Changes `input`.
void glide(const Layout& layout, const servo::Setup& setup, State& state, const servo::State& servo,
           const StationInputs& inputs, servo::Input& input);
DeviceCommands map_output(const Layout& layout, const servo::Setup& setup, State& state,
                          const servo::Output& output);

// The tool pose that a gloved hand commands, or would command if it held the tool (ToolPoses::commanded). A
// bare hand within handle_capture_distance of the wrench snaps to its handle: without touch nobody can place
// fingers around it to the millimetre.
Pose held_tool_pose(const Layout& layout, const servo::Setup& setup, const State& state,
                    const StationControls& controls);
inline constexpr double handle_capture_distance = 0.10;  // m from the handle's centre line to the fingertips

// Replaces tick() while StationControls::pause is set: reads the devices and returns zero commands.
// Afterwards the force ramps up. Commands received in a pause are executed in the first tick after it.
DeviceCommands pause_tick(const Layout& layout, const servo::Setup& setup, State& state,
                          const StationInputs& inputs);

// The largest lead of a pushed tool over its constrained pose, so that it reverses without delay.
inline constexpr double ahead = 0.01, turned_ahead = 0.15;  // m, rad
// Chosen: fingers that are pushed turn a nut `spinning` times faster than the puck's rate; at the largest
// torque a pushed wrench turns 1 + `firmness` times more slowly.
inline constexpr double spinning = 4.0, firmness = 15.0;
// s for which a rate is valid without a new sample.
inline constexpr double rate_timeout = 0.25;

}  // namespace bolt::station
