// A trial run of a station: the statistics of its devices, the timing of its servo, the faults that
// occurred, and the assessment whether it is fit for training.
#pragma once

#include "engine/base/function_ref.hpp"
#include "game/station/station_setup.hpp"

namespace bolt::station_setup {

// A fault and its duration.
struct Episode {
    std::string message;
    double from = 0.0;            // s
    std::optional<double> until;  // none: it persists
};

// Receives a message and its time, s.
using MessageHandler = FunctionRef<void(double time, const std::string& message)>;

// Updates the episodes from Station::fault_messages() at `time` and reports each fault that begins or ends.
// The loss of a device produces several messages in turn. So if a fault is gone less than 0.3 s after it
// began and a new one has appeared, both are taken for one, and the episode of the first is removed.
void update_episodes(std::vector<Episode>& episodes, std::span<const std::string> fault_messages, double time,
                     MessageHandler on_message);

struct DeviceTrial {
    device::Description description;
    station::LinkStats stats;
    std::uint64_t malformed_samples = 0, losses = 0;  // losses: disconnections
};

struct GloveTrial {
    std::filesystem::path port;
    hand::GloveReport report;
    double frames = 0.0;  // number of the glove's samples during the trial
    double age = 0.0;     // s since the latest sample
    std::optional<content::GloveCalibration> calibration;
    bool held = false;  // the hand holds the wrench
};

struct StationTrial {
    double seconds = 0.0;  // duration
    double rate = 1000.0;  // 1/s, of the servo
    std::optional<DeviceTrial> mover, wheel;
    std::optional<GloveTrial> glove;
    double dead_man_time = 0.0;  // s with the dead-man switch held
    servo::Timing timing;
    servo::ThreadPrivileges privileges;
    std::vector<Episode> episodes;
};

// Runs the trial for `seconds` or until `stop` returns true, then stops the station. Reports faults, and
// grasps and releases of a gloved hand. Without a glove the wrench counts as held.
StationTrial run_trial(station::Station& station, const PlannedStation& planned, double seconds,
                       const std::function<bool()>& stop, MessageHandler on_message);

// The privileges that the servo's thread has got, and those that the system refused; a line each.
std::string describe(const servo::ThreadPrivileges& privileges);

// Texts for the terminal: the devices with their roles and the button that enables their forces; the results.
std::string describe_station(station::DeviceLayout layout, const DeviceSelection& devices);
std::string trial_report(const StationTrial& trial);

// The reasons why the station is unfit for training, worst first; empty if it is fit.
std::vector<std::string> unfit_reasons(const StationTrial& trial);

}  // namespace bolt::station_setup
