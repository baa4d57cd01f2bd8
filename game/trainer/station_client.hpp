// Client of a haptic station in a lesson: the keyboard as a device, and the exchange of ticks, controls and
// commands.
#pragma once

#include <bitset>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/platform/input.hpp"
#include "game/lesson/hints.hpp"
#include "game/session/lesson_session.hpp"
#include "game/station/lesson_station.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/dragged_hand.hpp"
#include "game/trainer/equipment.hpp"
#include "game/trainer/helped_hand.hpp"
#include "game/trainer/tracked_hand.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::trainer {

// A keyboard as a puck, for a station in which no device moves the tool. W, A, S and D move the tool away, to
// the left, nearer and to the right; Q and E down and up. Left and right turn it about the vertical, up and
// down pitch it, page up and down roll it. The space bar is the puck's button.
class KeyboardPuck {
  public:
    // Losing the keyboard focus releases all keys.
    void handle_events(std::span<const platform::InputEvent> events);
    [[nodiscard]] device::PuckInput input() const;
    [[nodiscard]] bool button_down() const;
    [[nodiscard]] bool shift_down() const;

  private:
    std::bitset<256> down_;
};

// The lesson's side of a station. The station steps the ticks and serves the devices, on threads of its own
// or in LessonStation::step(). The lesson repeats every tick with its own servo, and sends its controls with
// every frame.
//
// The hand closes by a device's button or gripper, the space bar or a glove. If it closes beside the wrench,
// it takes the wrench; if it closes beside a nut, it holds the nut with the fingers. If both are
// within reach, the nearer one counts. A key lays the wrench down; a gloved hand and a gripper lay it down by
// opening.
struct StationClient {
    std::unique_ptr<station_setup::LessonStation> link;
    Pose home, rest;  // initial pose of the tool, and where the wrench lies
    // The wrist in the frame of the fingertips, while a gloved hand is empty.
    std::optional<Pose> empty_hand_wrist;
    KeyboardPuck keyboard;
    std::optional<DraggedHand> dragged;  // the mouse moves a simulated arm
    std::optional<TrackedHand> tracked;  // a headset's hand moves it
    WristMount wrist_mount;              // of a gloved hand

    // Received from the station.
    station::StationTick latest;
    std::vector<std::string> fault_messages;  // of devices and glove
    std::string wrist_fault;                  // of the Vive tracker of a gloved hand; empty: none
    device::DeviceHealth health;              // of the device that moves the tool
    device::ArmNeeds needs;                   // of the device that moves the tool, after it was lost
    hand::Skeleton fingers;  // of a gloved hand, in the frame of the wrench (held or at rest)
    bool gloved = false;
    bool has_gripper = false;  // of the device that moves the tool
    bool glove_lost = false;   // the glove sends no valid samples

    // Sent to the station.
    station::StationControls controls;
    bool tool_placed = false;            // PlaceTool was sent
    std::uint32_t checkpoints_sent = 0;  // number of station::SaveCheckpoint sent
    std::uint8_t restore_sent = 0;       // value of the last station::RestoreCheckpoint; 0: none pending

    // Derived from the latest tick.
    std::optional<std::size_t> near_nut;  // nut within reach of the tool
    bool near_wrench = false;             // the resting wrench is within reach of the hand
    bool nut_is_nearer = false;           // near_nut is nearer than the wrench: the hand closes on the nut
    double nut_angle_at_grip = 0.0;       // rad, angle of the held nut when it was engaged

    // Kept from frame to frame.
    bool hand_closed = false;      // in the previous frame
    std::string logged_fault;      // the last wrist_fault that was logged
    bool waits_for_arm = false;    // the lesson is paused until the arm has what it needs
    bool user_had_paused = false;  // the user had paused the lesson before the arm did
};

// Angle in rad by which a gloved hand can turn a nut before it has to let go and turn back. A forearm rotates
// by 80° either way (American Academy of Orthopaedic Surgeons, Joint motion, 1965); this is the comfortable
// part. Other hands have no limit.
inline constexpr double forearm_range = to_radians(120.0);

WorkingHand hand_of(const StationClient& client);

// Names what the user presses or moves for each control of the hand. `client`: null without a station.
lesson::ControlNames control_names(const words::Words& words, const KeyMap& keys, const Equipment& equipment,
                                   const StationClient* client);

// The user's input for the station in one frame.
struct UserActions {
    bool paused = false;
    bool toggle_wrench = false;       // the key that takes the wrench or lays it down
    bool recentre = false;            // move the tool to its initial pose
    std::optional<std::size_t> undo;  // number of steps to undo (steps_to_undo()); none: no request
    Quat view{1.0, 0.0, 0.0, 0.0};    // from the viewer's frame to the assembly's; pushes are relative to it
    std::int16_t second_wrench = -1;  // joint whose held part the second wrench is on; −1: none
};
// Call once a frame: reads the latest tick and sends controls and commands. Fails if the station's command
// queue is full.
[[nodiscard]] Status send_actions(StationClient& client, const session::LessonSession& session,
                                  const UserActions& actions);

// Lets the mouse move the hand that a headset has tracked. The tool stays where it is, and the hand keeps the
// wrench.
void give_hand_to_mouse(StationClient& client);
// Lets the headset track the hand again, which moves to where the real one is.
void give_hand_to_headset(StationClient& client, xr::Side side);

// Returns true if a device renders forces or torques, which then requires a dead-man switch: a button, the
// space bar, or a closed gloved hand.
bool needs_dead_man(const station::DeviceLayout& layout);

// m between thumb tip and index fingertip below which a gloved hand pinches.
inline constexpr double pinch_distance = 0.035;

}  // namespace bolt::trainer
