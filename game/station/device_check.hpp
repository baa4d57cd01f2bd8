// Examines one device on this computer: its rate, the delays that can be measured without a hand, and the
// stiffness that it renders stably with a hand on it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "haptics/device/device_thread.hpp"
#include "haptics/servo/servo_thread.hpp"
#include "haptics/station/stiffness_trial.hpp"

namespace bolt::station_setup {

struct DeviceCheck {
    device::Description description;
    device::DeviceHealth health;  // at the end
    double seconds = 0.0;         // in which samples were counted
    std::uint64_t samples = 0, malformed_samples = 0;
    servo::Histogram age;  // from the driver's reading of a sample until a tick of the servo took it
    // Calls of the driver that wrote a command, and their duration, s.
    std::uint64_t writes = 0;
    double mean_write = 0.0, longest_write = 0.0;
    std::optional<station::StiffnessTrial> stiffness;
    std::string why_not_measured;  // why there is no stiffness; empty: it was measured
};

struct DeviceCheckOptions {
    double seconds = 1.0;  // in which samples are counted
    // True: the user has agreed that the arm pushes the hand. False: `why_not_measured` states the reason.
    bool measures_stiffness = false;
    std::string why_not_measured;
    force::LimitBounds bounds;  // of the station file
    std::uint32_t dead_man =
        1;  // mask of the buttons that permit the force; a device without them needs none
    std::function<bool()> stop;  // returns true after the user has interrupted the check
};

// The largest force of the measurement of the stiffness, N; 0: the device renders no force.
double trial_force(const device::Description& description, const force::LimitBounds& bounds);

// Examines an open device, which is left without force. Fails if the device is lost or no thread can be
// created.
Result<DeviceCheck> check_device(device::DeviceThread& thread, const DeviceCheckOptions& options);

// Lines for the terminal. Each states what was measured.
std::string device_check_report(const DeviceCheck& check);

}  // namespace bolt::station_setup
