// Which HID devices are there that a hand can hold, and how they are opened. Through hidapi; the thread that
// opens a device is the one that uses it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/report_descriptor.hpp"
#include "haptics/device/rig.hpp"

namespace bolt::device {

enum class HidKind : std::uint8_t {
    puck,   // six axes that spring back; SpaceMouse class
    board,  // OpenFFBoard
    wheel,  // any other with USB's force feedback
    other,  // nothing for a hand that works, or nothing that we understand
};

struct HidIdentity {
    std::uint16_t vendor = 0, product = 0;
    std::string name, serial;  // may be empty
};

struct Listed {
    std::string path;  // /dev/hidraw3, say; may be another after every plugging in
    std::string id;    // 256f:c62e, with :SERIAL where it has one and #2 for a second of the same
    std::string name;
    HidKind kind = HidKind::other;
    std::optional<Error> trouble;  // why it cannot be used, and what mends that
};

// What is there now. `others`: keyboards and the like too.
std::vector<Listed> list(bool others = false);

Result<std::unique_ptr<Device>> open(const Listed& listed, const Rig& rig = {}, const PuckFeel& feel = {});

// Looks for the id anew whenever it is asked to open.
Open opener(std::string id, const Rig& rig = {}, const PuckFeel& feel = {});

// Pure parts of the above.
HidKind kind_of(const HidIdentity& who, const ReportDescriptor& descriptor);
std::string id_of(const HidIdentity& who);
// What to write into udev's rules for a device that the shipped ones do not know.
std::string udev_line(const HidIdentity& who);

}  // namespace bolt::device
