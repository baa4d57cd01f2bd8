// The devices that a user chooses for a lesson, in the menu or on the command line, and how mouse and
// keyboard move the hand without one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "content/station/station_file.hpp"

namespace bolt::trainer {

// The way in which mouse, keyboard or headset move the hand if no device does.
enum class HandMode : std::uint8_t {
    helped,         // the mouse chooses a nut, and the hand goes there automatically (--hand helped)
    free,           // the mouse moves a hand that feels the forces of a simulated arm; frames run the ticks
    keyboard,       // keys move the tool like a puck
    simulated_arm,  // as `free`, on the threads of a station like a real arm
    tracked,        // a headset measures the hand; frames run the ticks
};

// The input of a lesson: mouse and keyboard, or a station with devices.
struct Equipment {
    std::vector<std::string> devices;  // ids, as boltwright devices lists them
    // Settings of the devices. Those of a device that `devices` does not list are ignored, and so is the
    // glove of the file: see `glove`.
    content::StationFile station;
    std::filesystem::path wheel_config_file;  // empty: the station's, or the defaults of device::WheelConfig
    std::filesystem::path glove;              // serial port; empty: no glove
    double force_scale = 1.0;                 // 0 … 1 of the devices' maximum force
    HandMode hand = HandMode::helped;         // if none of the devices moves the hand

    // True if opening the devices may take seconds, or last until the user has prepared an arm.
    [[nodiscard]] bool has_hardware() const { return !devices.empty() || !glove.empty(); }
    [[nodiscard]] bool needs_station() const { return has_hardware() || hand != HandMode::helped; }
    // True if neither a device nor a chosen HandMode moves the hand, so a headset may.
    [[nodiscard]] bool hand_unassigned() const { return devices.empty() && hand == HandMode::helped; }
    bool operator==(const Equipment&) const = default;
};

// The equipment of a study's lesson: `base`, with its devices replaced by `devices`, if there are any.
// Accepts the values of --device except "auto". `free`: the mouse moves a free hand instead of a helped one,
// if no device moves the hand.
Equipment equipment_for(const std::vector<std::string>& devices, bool free, Equipment base);

// Applies a study's "glove": "none", "auto" or a serial port. Empty: the glove stays as it is.
void use_glove(const std::string& glove, Equipment& equipment);

// An entry in the menu of devices.
struct DeviceOption {
    std::string name;  // names of the devices; empty: none, and Equipment::hand says what moves the hand
    Equipment equipment;
};
// Mouse and keyboard with a helped and with a free hand, the combinations of the devices that are connected
// now, and the devices of `chosen`, such as those of a station file.
std::vector<DeviceOption> device_options(const Equipment& chosen);
// Adds the hands of a headset to the menu, if they are not in it.
void offer_tracked_hand(std::vector<DeviceOption>& options);
// The default: the connected device that moves the tool, together with a wheel if there is one; else the
// mouse.
Equipment default_equipment();

}  // namespace bolt::trainer
