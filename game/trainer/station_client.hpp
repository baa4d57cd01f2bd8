// Somebody who plays at a station: the servo's thread has the ticks and the devices, the lesson follows tick
// by tick with a servo of its own (session::Course::take), and what is wished goes back with every picture.
//
// A hand closes by a device's button, the space bar or a glove. Closed beside the wrench it takes that,
// closed beside a nut it holds it with its fingers. A key lays the wrench down; a gloved hand lets go of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "game/session/lesson_session.hpp"
#include "game/station/bench.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/mouse_hand.hpp"
#include "game/trainer/pushing.hpp"

namespace bolt::trainer {

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
