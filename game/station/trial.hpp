// A trial run of a station: statistics of its devices, the timing of its servo, the problems that occurred,
// and the assessment whether it is fit for training.
#pragma once

#include "engine/base/function_ref.hpp"
#include "game/station/station_setup.hpp"

namespace bolt::station_setup {

// A problem and the time for which it lasted.
struct Episode {
    std::string words;
    double from = 0.0;            // s
    std::optional<double> until;  // none: it persists
};

// Receives a message and its time, s.
using Tell = FunctionRef<void(double time, const std::string& words)>;

// Updates the episodes from Station::troubles() at `time`; calls `tell` when a problem begins or ends. A
// problem that another message replaces within 0.3 s was the onset of that one and is dropped.
void note(std::vector<Episode>& episodes, std::span<const std::string> troubles, double time, Tell tell);

struct TriedDevice {
    device::Description description;
    station::LinkStats stats;
    std::uint64_t malformed = 0, losses = 0;
};

struct TriedGlove {
    std::filesystem::path port;
    hand::GloveReport report;
    double frames = 0.0;  // during the trial
    double age = 0.0;     // s since the latest frame
    std::optional<content::GloveCalibration> worn;
    bool held = false;  // the hand holds the wrench
};

struct Trial {
    double seconds = 0.0;
    double rate = 1000.0;  // 1/s, of the servo
    std::optional<TriedDevice> mover, wheel;
    std::optional<TriedGlove> glove;
    double enabled = 0.0;  // s with the dead-man switch held
    servo::Timing timing;
    servo::ThreadPrivileges privileges;
    std::vector<Episode> episodes;
};

// Runs the trial for `seconds` or until `stop` returns true, then stops the station. `tell` receives
// problems, and grasps and releases of a gloved hand. Without a glove the wrench counts as held.
Trial try_station(station::Station& station, const Planned& planned, double seconds,
                  const std::function<bool()>& stop, Tell tell);

// For the terminal: the devices, their roles, and the button that enables their forces.
std::string introduce(station::Layout layout, const Choice& choice);
std::string report(const Trial& trial);

// The reasons against training with the station, worst first; empty: it is fit.
std::vector<std::string> against(const Trial& trial);

}  // namespace bolt::station_setup
