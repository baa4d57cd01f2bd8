// Derives sound cues from the servo's output. A replayed session therefore gives the same sounds as the
// lesson. detect_events reads no clock and allocates nothing.
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

// Returns the surface of each fixed obstacle, by the index of its ObstacleId. Bolts and washers, whose names
// begin with a joint's id (`B1_washer`), sound like nuts; all others like castings.
std::vector<StruckSurface> struck_surfaces(const content::Assembly& assembly,
                                           std::span<const session::ObstacleName> names);

// The cues of a tick that come from the lesson.
struct LessonCues {
    bool done = false;     // a step of a joint was done
    bool mistake = false;  // a mistake was made
};

// `events`: the lesson's events of one tick.
LessonCues lesson_cues(std::span<const lesson::LessonEvent> events);

// State of the detection between ticks.
struct EventDetector {
    std::vector<StruckSurface> surfaces;  // result of struck_surfaces; obstacles beyond its end are castings

    // The positions, m, of both ends of the wrench.
    struct WrenchEnds {
        Vec3 jaw{0.0}, handle{0.0};
    };
    static constexpr std::size_t max_history = 32;      // ticks
    std::array<WrenchEnds, max_history + 1> history{};  // newest first
    std::size_t history_size = 0;                       // valid entries of `history`
    std::size_t ticks_since_contact = max_history;
    StruckSurface last_surface = StruckSurface::casing;  // of the last contact
    double since_strike = 0.0;                           // s since the last strike
    double last_strike = 0.0;                            // m/s, speed of the last strike
    double pending_strike = 0.0;  // m/s, highest speed lost so far in a strike in progress; 0: none

    // Values of the last tick.
    std::int16_t joint = -1;
    double nut_angle = 0.0;      // rad
    double load = 0.0;           // clamp force over the reference load of the joint, as load_of() returns
    double ratchet_slack = 0.0;  // rad
};

// The components that the cues are derived from.
using Audible = ecs::Access<const world::Joint, const world::ConstrainedTool, const world::ToolState,
                            const world::DeviceForce>;

// Returns the cues of the tick whose output haptic_system has just written to `world`.
SoundCues detect_events(EventDetector& detector, const servo::Setup& setup, const Audible& world,
                        const LessonCues& lesson = {});

}  // namespace bolt::sound
