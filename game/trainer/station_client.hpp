// Keys as a puck in the hand: where nothing but a keyboard moves the tool of a station.
#pragma once

#include <bitset>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/platform/input.hpp"
#include "game/session/lesson_session.hpp"
#include "game/station/station_setup.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/mouse_hand.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::trainer {

// W A S D away, to the left, nearer and to the right, Q and E down and up; left and right turn the tool about
// the upright, up and down tip it, page up and down roll it; the space bar is the puck's button.
class Pushing {
  public:
    // Takes in what was pressed and let go of. A window that has lost the keyboard pushes nothing.
    void take(std::span<const platform::Event> events);
    [[nodiscard]] device::PuckInput push() const;
    [[nodiscard]] bool closes() const;  // the space bar is down

  private:
    std::bitset<256> down_;
};

// What a hand plays with: mouse and keyboard, or a station of what is plugged in.

struct Equipment {
    std::vector<std::string> devices;  // ids, as boltwright devices has them
    std::filesystem::path rig;         // what is known of a wheel; may be empty
    std::filesystem::path glove;       // its port; empty: none
    double force_scale = 1.0;          // 0 … 1 of the forces that devices may render
    bool keyboard = false;  // a station without a device: keys move the tool, and the servo has a thread

    [[nodiscard]] bool none() const { return devices.empty() && glove.empty() && !keyboard; }  // the mouse
    bool operator==(const Equipment&) const = default;
};

// Something to choose: what is there now.
struct Seat {
    std::string name;  // in words, of the devices; empty: mouse and keyboard
    Equipment with;
};
std::vector<Seat> seats();
// What suits whoever says nothing: a device that moves the tool, and with it a wheel; else the mouse.
Equipment usual_equipment();

// A station of that for the lesson, paused. `trainee` wears the glove.
Result<std::unique_ptr<station_setup::Bench>> start_station(const content::Assembly& assembly,
                                                            const session::CourseOptions& course,
                                                            const Equipment& with,
                                                            const std::string& trainee);

// Somebody who plays at a station: the servo's thread has the ticks and the devices, the lesson follows tick
// by tick with a servo of its own (session::Course::take), and what is wished goes back with every picture.
//
// A hand closes by a device's button, the space bar or a glove. Closed beside the wrench it takes that,
// closed beside a nut it holds it with its fingers. A key lays the wrench down; a gloved hand lets go of it.

struct StationClient {
    std::unique_ptr<station_setup::Bench> bench;
    Pose home, rest;                 // where the tool begins, and where the wrench lies
    std::optional<Pose> bare_wrist;  // station::StationControls
    Pushing keys;

    station::TickRecord now;  // the newest
    station::StationControls controls;
    bool placed = false;                 // the tool was sent to `home`
    std::uint32_t checkpoints_sent = 0;  // station::SaveCheckpoint since the beginning
    std::uint8_t restore_sent = 0;       // steps of the last station::RestoreCheckpoint; 0: none is asked for
    bool closed = false;                 // the hand, in the last picture
    std::optional<std::size_t> near;     // nut that the tool is at
    bool near_wrench = false;            // the hand is where it could take it
    std::vector<std::string> troubles;
    hand::Skeleton fingers;  // of a gloved hand, in the frame of the wrench in the hand or where that lies
    bool gloved = false;
    bool glove_lost = false;
    double taken_at = 0.0;  // rad, of the nut in the hand when it was taken
};

// rad that the fingers of a gloved hand turn the nut that they hold, before they let go and turn back. A
// forearm turns by 80° either way (American Academy of Orthopaedic Surgeons, Joint motion, 1965): of that,
// what is no strain. Any other hand has no end.
inline constexpr double forearm_turns = to_radians(120.0);

Hand hand_of(const StationClient& at);

// What is wished of the station after a picture. `looks`: how whoever pushes looks at the machine.
struct Asked {
    bool paused = false;
    bool tool = false;      // the key that lays the wrench down
    bool recentre = false;  // the tool goes back to where it was at the beginning
    std::optional<std::size_t> undo;
    Quat looks{1.0, 0.0, 0.0, 0.0};
};
// Fails if the station's command queue is full.
[[nodiscard]] Status wish(StationClient& at, const session::Course& course, const Asked& asked);

// Whether forces go out only as long as somebody holds a button, or the tool in a gloved hand.
bool has_dead_man(const station::Layout& layout);

// m from thumb's to index finger's tip below which a gloved hand pinches.
inline constexpr double pinch = 0.035;

}  // namespace bolt::trainer
