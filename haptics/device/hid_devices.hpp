// Lists the connected HID devices and opens them (hidapi). The thread that opens a device must be the one
// that uses it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

enum class HidKind : std::uint8_t {
    puck,   // six axes that spring back; SpaceMouse class
    board,  // OpenFFBoard
    wheel,  // any other device with USB force feedback
    other,  // unsupported
};

struct HidIdentity {
    std::uint16_t vendor = 0, product = 0;
    std::string name, serial;  // may be empty
};

struct ListedDevice {
    std::string path;  // for example /dev/hidraw3; changes when the device is replugged
    // VENDOR:PRODUCT[:SERIAL], for example 256f:c62e; #2 is appended for a second identical device.
    std::string id;
    std::string name;
    HidKind kind = HidKind::other;
    std::optional<Error> trouble;  // why it cannot be used, with a remedy
};

// The devices connected now; with `others` also unsupported ones such as keyboards.
std::vector<ListedDevice> list_devices(bool others = false);

Result<std::unique_ptr<DeviceDriver>> open(const ListedDevice& listed, const WheelConfig& config = {},
                                           const PuckResponse& response = {});

// The factory searches for the id each time it opens.
DeviceFactory factory_for(std::string id, const WheelConfig& config = {}, const PuckResponse& response = {});

// The decisions of list_devices() and open(), from the arguments alone.
HidKind kind_of(const HidIdentity& identity, const ReportDescriptor& descriptor);
std::string id_of(const HidIdentity& identity);
// A udev rule for a device that tools/udev does not cover.
std::string udev_rule(const HidIdentity& identity);

}  // namespace bolt::device
