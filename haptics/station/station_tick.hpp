// The tick of a station: its devices and their layout, its inputs from the application, and the step that
// maps them to the servo's input and the servo's output to the devices' commands. Pure, of fixed dt, without
// allocation, lock, clock or I/O.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <variant>

#include "engine/base/math.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/device_thread.hpp"
#include "haptics/force/device_mapping.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::station {

// Bit masks of a device's buttons; 0: no button has that function. While the clutch is held, the tool stands
// still and the hand can move the device freely, as when a mouse is lifted.
struct Buttons {
    std::uint32_t dead_man = 1;
    std::uint32_t clutch = 2;
    std::uint32_t stop = 0, reset = 0;
    bool operator==(const Buttons&) const = default;
};

// Which device moves the tool, which one turns the wrench on its bolt, and the transforms between their
// frames and the assembly's.
struct DeviceLayout {
    std::optional<device::Description> mover;  // moves the tool: Sensing::pose or velocity
    Buttons mover_buttons;
    // Turns the wrench on its bolt and renders the torque: Sensing::angle. With a wheel the mover renders
    // forces only.
    std::optional<device::Description> wheel;
    Buttons wheel_buttons;
    force::WorkspaceMap workspace;  // of the mover; if the mover senses velocity, only `rotation` applies
    Pose home;                      // initial pose of the tool in the assembly's frame
    // Pose of the wrist of a gloved hand that holds the tool, in the tool's frame; none: no gloved hand.
    std::optional<Pose> wrist;
};

// Fails with ErrorCode::no_device if there is no device or a device cannot take its role.
Status check(const DeviceLayout& layout);

// s; upper bound of the sum of two delays: from a sample's arrival until the servo reads it, and from a
// command until the device thread reads it. Subtracted from the time in which forces must be released.
inline constexpr double transport_delay = 2e-3;

// Distance (m) from the tool's origin to the point that follows the mover. It is `handle_length` if the mover
// senses the pose of the hand and no device renders torque: the mover's force then acts at the end of the
// handle. Otherwise it is 0: the head of the tool follows the mover, and the mover's rotation turns the tool.
double lever_arm_of(const DeviceLayout& layout, double handle_length);

// The combined limits of the devices in the assembly's units, for servo::SetupDescription::limits.
force::OutputLimits limits_of(const DeviceLayout& layout);

// Return true if the device renders force or torque, respectively, along or about any axis.
bool renders_force(const device::Description& description);
bool renders_torque(const device::Description& description);

// The application's inputs. StationControls are states: only the latest value counts. StationCommands are
// events: each is executed once, in order, and none is lost.

struct StationControls {
    servo::Grip grip = servo::Grip::none;  // `wrench` has no effect if a gloved hand determines the grip
    bool dead_man = false;                 // held in the application; a device's button has the same effect
    // s after which `dead_man` expires unless the controls are sent again. A window that hangs thus releases
    // the dead-man switch.
    double dead_man_timeout = std::numeric_limits<double>::infinity();
    bool clutch = false, stop = false, reset = false;  // pressed in the application, as devices' buttons
    std::int16_t guided_joint = -1;                    // joint that the guiding force leads to; −1: none
    float set_torque = 0.0F;                           // N·m, of a click-type torque wrench
    std::uint8_t tool = 0;            // index in Setup::tools of the tool that the hand gets next
    std::int16_t second_wrench = -1;  // joint whose held part the second wrench is on; −1: none
    // Unit, from the viewer's frame to the assembly's. A puck moves the tool in the viewer's frame, an arm in
    // the assembly's frame rotated about the vertical to face the viewer.
    Quat view{1.0, 0.0, 0.0, 0.0};
    bool pause = false;  // no servo tick and no force; the tool stands still while the hand may move
    // Where the wrench lies until a hand takes it, in the assembly's frame. None: it has no such place, and
    // an open hand carries it along.
    std::optional<Pose> wrench_rest_pose{};
    // The wrist of an empty gloved hand, in the frame whose origin is between the fingertips (servo/io.hpp):
    // the mover then moves the fingertips. None: the mover moves the hand as if the hand held the wrench.
    std::optional<Pose> empty_hand_wrist{};
    // Joint whose nut attracts the tool; −1: none. Applies only to a device that senses velocity and renders
    // no force: the station then moves the tool to the nut.
    std::int16_t approach_joint = -1;
};

// Moves the tool to a pose in the assembly's frame. The device need not move: from then on the tool moves
// from this pose as the device moves from its present one.
struct PlaceTool {
    Pose tool{};
};
// Stores the state of the nuts for undo. Checkpoints are saved one a tick, before a pending restore.
struct SaveCheckpoint {};
// Restores the n-th last checkpoint, 1 … servo::max_checkpoints. It stays pending until the servo
// permits it (see servo::TickInput::checkpoint_action), and replaces a pending restore. A command with more
// steps than servo::max_checkpoints is ignored.
struct RestoreCheckpoint {
    std::uint8_t steps = 1;
};
// Changes a pending restore, or cancels it if `steps` is 0. Has no effect if no restore is pending, so that a
// restore that completed in the meantime is not repeated.
struct AmendRestore {
    std::uint8_t steps = 0;
};

using StationCommand = std::variant<PlaceTool, SaveCheckpoint, RestoreCheckpoint, AmendRestore>;

// Commands that fit into a station's queue. The servo thread takes up to 16 of them in every tick, in a pause
// too, so the queue fills only if that thread does not run. Station::send then fails.
inline constexpr std::size_t command_queue_capacity = 64;

struct StationInputs {
    device::DeviceSnapshot mover, wheel;
    StationControls controls;
    double controls_age = 0.0;                   // s since the controls were sent
    std::span<const StationCommand> commands{};  // received since the last tick, in order
    std::optional<servo::Grip> hand_grip;        // of a gloved hand; none: no gloved hand
    std::uint64_t missed = 0;                    // deadlines of the servo without a tick since the last tick
};

// The gripper of the mover. A closed gripper closes the trainee's hand and also counts as a held dead-man
// switch.
struct Gripper {
    double opening = 1.0;  // 0 closed … 1 fully open
    bool closed = false;
};
// Openings at which an open gripper counts as closed, and a closed one as open. Chosen values: a hand that
// holds the handle of a wrench is half closed, and must not lose the wrench by trembling.
inline constexpr double gripper_closes_below = 0.35, gripper_opens_above = 0.55;

// The state of the connection to one device.
struct DeviceLink {
    // Number of the last sample, and DeviceSnapshot::connection_number of the device when it was read.
    std::uint64_t number = 0, connection_number = 0;
    double silence = 0.0;      // s since the last sample
    bool fresh = false;        // a sample arrived in this tick
    bool usable = false;       // DeviceSnapshot::usable in this tick
    double force_share = 0.0;  // 0 … 1, share of the force that the device renders
};

struct StationState {
    DeviceLink mover, wheel;
    force::WorkspaceState workspace;
    Pose mover_pose;                // last one, in the mover's frame
    Gripper gripper;                // of the mover, last sample
    double wheel_angle = 0.0;       // rad, last sample of the wheel
    Vec3 bolt_axis{0.0, 1.0, 0.0};  // unit, of the bolt that the wheel turns or turned last
    double wheel_fade = 0.0;        // 0 … 1, share of the bolt's torque that the wheel renders
    bool restarting = false;        // after a stall or a pause: no force until the output stage is at zero
    // Pose of the wrench while no hand holds it; needs StationControls::wrench_rest_pose.
    std::optional<Pose> resting_wrench;
    int pivot_joint = -1;              // joint whose bolt the wrench pivots about; −1: none
    force::GuideState approach_guide;  // of the approach to StationControls::approach_joint
    int followed_nut = -1;             // joint whose nut moves the tool along (see move_to_nut()); −1: none
    Vec3 followed_point{0.0};          // m, centre of that nut at the last tick
    // Commands received and not executed yet.
    std::optional<Pose> tool_to_place;
    std::uint32_t checkpoints_to_save = 0;
    std::uint8_t checkpoint_to_restore = 0;  // 0: none
    bool stopped_in_pause = false;           // a stop pressed in a pause takes effect afterwards
    bool dead_man_pressed = false;           // by a button or the gripper of a device, in this tick
    servo::TickInput input;                  // of the last tick
    servo::Output output;
};

struct DeviceCommands {
    force::OutputCommand mover, wheel;  // each in its device's frame
};

StationState initial_state(const DeviceLayout& layout);

// One tick. Forces come from the servo's output stage; this code maps them and may only reduce them. A device
// that is lost or silent for too long moves nothing and renders no force. When the device returns, the hand
// may be anywhere, so the mapping is realigned, as after a clutch.
DeviceCommands tick(const DeviceLayout& layout, servo::Setup& setup, StationState& state, servo::State& servo,
                    const StationInputs& inputs);

// The parts of tick(), in order. Before the servo's tick, read_inputs() moves the tool by the devices and
// makes the servo's input. After it, map_output() makes the devices' commands from the servo's output.
// pivot_about_bolt(), which read_inputs() calls, and move_to_nut() are implemented in near_nut.cpp.
servo::TickInput read_inputs(const DeviceLayout& layout, const servo::Setup& setup, StationState& state,
                             const StationInputs& inputs);
// On a bolt and near it the mover moves the end of the wrench's handle, and the wrench turns so that its jaw
// points to the bolt. The mover's orientation has no effect, because a device without torque cannot hold the
// wrist, and a hand cannot align a jaw with the bolt to 1°. Does nothing if the lever arm is 0
// (lever_arm_of()). `last`: the tool's pose before this tick.
void pivot_about_bolt(const DeviceLayout& layout, const servo::Setup& setup, StationState& state,
                      const Pose& last, double dt);
// Moves the tool if its device senses velocity and renders no force: along with a held nut, and towards the
// nut of StationControls::approach_joint. Changes `input`.
void move_to_nut(const DeviceLayout& layout, const servo::Setup& setup, StationState& state,
                 const servo::State& servo, const StationInputs& inputs, servo::TickInput& input);
DeviceCommands map_output(const DeviceLayout& layout, const servo::Setup& setup, StationState& state,
                          const servo::Output& output);

// The pose at which a gloved hand holds the tool, or would hold it if it closed. The mover commands it; the
// glove measures only the fingers. An empty gloved hand within handle_capture_distance of
// the wrench snaps to its handle: without touch nobody can place fingers around it to the millimetre.
Pose tool_of_gloved_hand(const DeviceLayout& layout, const servo::Setup& setup, const StationState& state,
                         const StationControls& controls);
inline constexpr double handle_capture_distance = 0.10;  // m from the handle's centre line to the fingertips

// Replaces tick() while StationControls::pause is set: reads the devices and returns zero commands.
// Afterwards the force ramps up. Commands received in a pause are executed in the first tick after it.
DeviceCommands pause_tick(const DeviceLayout& layout, const servo::Setup& setup, StationState& state,
                          const StationInputs& inputs);

// The last sample of a mover that senses its pose.
struct MoverSample {
    Pose pose;  // in the frame of the device
    std::uint32_t buttons = 0;
};

// One tick, for recording.
struct StationTick {
    std::uint64_t number = 0;  // number of the servo's deadline; missed deadlines count too
    servo::TickInput input;
    servo::Output output;
    Pose commanded_tool;  // in the assembly's frame
    // Pose of the mover's frame in the assembly's: maps the position of the mover to the point of the tool
    // that follows it (lever_arm_of()). Valid at a scale of 1. The clutch changes it.
    Pose mover_in_assembly;
    // The mover's last pose in its own frame and its buttons, also in a pause; none without a mover that
    // senses its pose, and while the mover sends no samples.
    std::optional<MoverSample> mover;
    // Pose of the wrench while no hand holds it (StationControls::wrench_rest_pose).
    std::optional<Pose> resting_wrench;
    bool dead_man_pressed = false;  // by a button or the gripper of a device
    Gripper gripper;
};

struct StationStep {
    DeviceCommands commands;
    StationTick tick;
    bool paused = false;  // no servo tick, so nothing to record
};
// Calls tick(), or pause_tick() while StationControls::pause is set. `number`: StationTick::number.
StationStep step(const DeviceLayout& layout, servo::Setup& setup, StationState& state, servo::State& servo,
                 const StationInputs& inputs, std::uint64_t number);

// The following apply to a tool whose device senses velocity (Sensing::velocity).
//
// The commanded pose is at most this far ahead of the constrained pose, so that a reversal acts at once.
inline constexpr double max_ahead = 0.01, max_angle_ahead = 0.15;  // m, rad
// Fingers turn a nut `finger_velocity_factor` times faster than the velocity that the device senses; at the
// largest torque a wrench turns 1 + `torque_slowdown` times more slowly. Chosen values.
inline constexpr double finger_velocity_factor = 4.0, torque_slowdown = 15.0;
// s for which a velocity is valid without a new sample.
inline constexpr double velocity_timeout = 0.25;

}  // namespace bolt::station
