// Lists the connected devices and opens them: HID devices (hidapi), and arms (arms.hpp). The thread that
// opens a device must be the one that uses it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

class UnfinishedCalibrations;  // plugin_arms.hpp

enum class DeviceKind : std::uint8_t {
    arm,           // through its vendor's library or service (arms.hpp); renders forces
    puck,          // six axes that spring back; SpaceMouse class
    open_ffboard,  // a wheel driven by an OpenFFBoard, an open-source motor controller
    wheel,         // any other device with USB force feedback
    other,         // unsupported
};

struct HidIdentity {
    std::uint16_t vendor = 0, product = 0;
    std::string name, serial;  // may be empty
};

struct ListedDevice {
    // HID device: its node, for example /dev/hidraw3; changes when the device is replugged. Arm: its library
    // or service.
    std::string path;
    // An arm: BACKEND:INDEX, for example force-dimension:0, or plugin:NAME:INDEX. Others:
    // VENDOR:PRODUCT[:SERIAL], for example 256f:c62e; #2 is appended for a second identical device.
    std::string id;
    std::string name;
    DeviceKind kind = DeviceKind::other;
    std::optional<Error> error;  // why it cannot be used, with a remedy

    // False if the device cannot be opened. An arm that only needs its preparation counts as usable.
    [[nodiscard]] bool usable() const { return !error || preparation_of(*error).need != DeviceNeed::none; }
};

// The devices connected now; with `others` also unsupported ones such as keyboards.
std::vector<ListedDevice> list_devices(bool others = false);

// kg, largest mass of a handle or tool that is mounted on an arm. The arms can lift 1 to 2 kg, depending on
// the model; this limit leaves a part for rendered forces.
inline constexpr double max_effector_mass = 1.0;

struct OpenOptions {
    WheelConfig wheel{};
    PuckResponse puck{};
    bool arm_may_move = false;  // an arm may move by itself to find its position, if it has not done so yet
    // kg, of the handle or tool that is mounted on an arm, for the compensation of its weight; at most
    // `max_effector_mass`. 0: the handle that the factory has mounted.
    double effector_mass = 0.0;
    std::shared_ptr<UnfinishedCalibrations>
        unfinished_calibrations{};                 // keeps plug-in arms open between attempts; may be null
    std::shared_ptr<MovePermission> permission{};  // factory_for() sets `arm_may_move` from it; may be null
};

Result<std::unique_ptr<DeviceDriver>> open(const ListedDevice& listed, const OpenOptions& options = {});

// The factory looks the id up at each opening.
DeviceFactory factory_for(std::string id, const OpenOptions& options = {});

// The pure parts of list_devices() and open().
DeviceKind kind_of(const HidIdentity& identity, const ReportDescriptor& descriptor);
std::string id_of(const HidIdentity& identity);
// A udev rule for a device that tools/udev does not cover.
std::string udev_rule(const HidIdentity& identity);

}  // namespace bolt::device
