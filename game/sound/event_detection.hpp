// What the obstacles of an assembly sound like, by the number that the servo's output has for them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/session/session_file.hpp"
#include "game/sound/synth.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::sound {

// Bolts and washers sound as nuts do: parts whose names begin with a joint's id, as `B1_washer` does. All
// others are taken for castings.
std::vector<Met> materials(const content::Assembly& assembly, std::span<const session::ObstacleName> names);

// From ticks to what there is to be heard of them: nothing but the servo's output decides, so that a session
// that is replayed sounds as it did. No clock, no allocation; the same ticks give the same numbers.

// What the lesson adds to a tick.
struct Cues {
    bool done = false;     // a step of a joint was done in this tick
    bool mistake = false;  // a mistake was made in it
};

// Of what the lesson said in a tick (Lesson::events).
Cues cues_of(std::span<const lesson::Event> events);

struct Ear {
    std::vector<Met>
        still;  // what stands still sounds like, by its number (materials.hpp); not known: castings

    // Ends of the wrench, m, in the ticks before, newest first; as far back as a strike is looked for.
    struct Ends {
        Vec3 jaw{0.0}, grip{0.0};
    };
    static constexpr std::size_t most_back = 32;
    std::array<Ends, most_back + 1> was{};
    std::size_t known = 0;              // of them
    std::size_t untouched = most_back;  // ticks
    Met met = Met::casing;              // what was touched last
    double since_strike = 0.0;          // s
    double last_strike = 0.0;           // m/s
    double rising = 0.0;                // m/s, of a strike that is not over

    std::int16_t joint = -1;
    double nut_angle = 0.0;  // rad
    double load = 0.0;
};

// The components that sound is made from. All of it is in the servo's output, so a replayed session sounds
// the same.
using Audible =
    ecs::Access<const world::Joint, const world::Tool, const world::ToolContact, const world::DeviceForce>;

// Returns the sounds of one tick, which haptic_system has just written.
Heard hear(Ear& ear, const servo::Setup& setup, const Audible& world, const Cues& cues = {});

}  // namespace bolt::sound
