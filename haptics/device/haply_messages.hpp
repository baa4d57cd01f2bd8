// The messages of Haply's service (its documentation, 3.1 to 3.5): JSON, in m, m/s and N, in a frame with x
// to the right, y forward (away from the user) and z up. All messages are validated: a message that is not
// JSON, lacks a field or has an implausible value is an error.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::device {

struct HaplyArmEntry {
    std::string id;           // printable ASCII without quotes
    bool calibrated = false;  // otherwise its positions are wrong
    Vec3 middle{0.0};         // m, middle of the reach, in the service's frame
};

// A VerseGrip (haply.hpp).
struct HaplyGripEntry {
    std::string id;
    bool wireless = false;  // three buttons instead of one
};

// The first message of a connection.
struct HaplyInventory {
    std::vector<HaplyArmEntry> arms;
    std::vector<HaplyGripEntry> grips;  // wireless ones first
};

// Fails for an arm of another type or with other axes: its limits or its forces would be wrong.
Result<HaplyInventory> parse_haply_inventory(std::string_view message);

// Every later message, in our frame: x to the right, y up, z to the user.
struct HaplyState {
    Vec3 position{0.0};               // m, from the middle of the reach
    Vec3 velocity{0.0};               // m/s
    std::optional<Quat> orientation;  // unit, of the grip; nullopt: the message has none
    std::uint32_t buttons = 0;        // bit 0: a wired grip's button, or button a; bits 1, 2: b, c
};

// A null `grip`: the arm has none. Error::lost is set if the arm is missing, or no longer calibrated.
Result<HaplyState> parse_haply_state(std::string_view message, const HaplyArmEntry& arm,
                                     const HaplyGripEntry* grip);

// Returns the reason if an event states that the arm renders no more force; nullopt for all other events.
std::optional<std::string> loss_in_haply_event(std::string_view message, const HaplyArmEntry& arm);

// Returns true if the answer to GET /version names a version before 3.5, false for later ones, nullopt if it
// names none.
std::optional<bool> is_old_haply_version(std::string_view answer);

// The message that renders `force` (N, our frame, finite) for one tick. `old`: for services before 3.5.
std::string haply_force_message(const HaplyArmEntry& arm, const Vec3& force, bool old);

}  // namespace bolt::device
