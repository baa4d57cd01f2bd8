// A station that somebody tries: what its devices told and were sent, how the servo kept its time, what was
// wrong and when, and whether that is good enough to train with.
#pragma once

#include "engine/base/function_ref.hpp"
#include "game/station/plan.hpp"

namespace bolt::station {

// Something that was wrong for a while.
struct Episode {
    std::string words;
    double from = 0.0;            // s
    std::optional<double> until;  // none: it still is
};

// Gets what happened, in words, and when (s).
using Tell = FunctionRef<void(double time, const std::string& words)>;

// What Station::troubles() says at this time; what has begun or ended is told. What is said in other
// words a moment later was the beginning of that, and is forgotten.
void note(std::vector<Episode>& episodes, std::span<const std::string> troubles, double time, Tell tell);

struct TriedDevice {
    device::Description description;
    Traffic traffic;
    std::uint64_t malformed = 0, losses = 0;
};

struct TriedGlove {
    std::filesystem::path port;
    glove::Report report;
    double frames = 0.0;  // while it was tried
    double age = 0.0;     // s, of the newest
    std::optional<content::GloveCalibration> worn;
    bool held = false;  // the hand has the wrench
};

struct Trial {
    double seconds = 0.0;
    double rate = 1000.0;  // 1/s, of the servo
    std::optional<TriedDevice> mover, wheel;
    std::optional<TriedGlove> glove;
    double enabled = 0.0;  // s that the dead-man was held
    servo::Timing timing;
    servo::Granted granted;
    std::vector<Episode> episodes;
};

// Tries a station for `seconds`, or until `stop`; the station is stopped then. Told is what goes wrong, and
// when a gloved hand takes the wrench and lets it go; a hand without a glove holds it.
Trial try_station(Station& station, const Planned& planned, double seconds, const std::function<bool()>& stop,
                  Tell tell);

// For a terminal: which devices there are and what for, and how their forces are let out.
std::string introduce(Layout layout, const Choice& choice);
std::string report(const Trial& trial);

// What speaks against training with it, worst first; empty: it is good enough.
std::vector<std::string> against(const Trial& trial);

}  // namespace bolt::station
