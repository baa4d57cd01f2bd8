// Which of the devices that are there a station uses, and what for. Pure: device::list_devices() says what is
// there.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptics/device/hid_devices.hpp"

namespace bolt::station_setup {

enum class Use : std::uint8_t {
    mover,  // moves the tool
    wheel,  // turns the wrench on its bolt and renders its torque
};
// The role of such a device; none: a station cannot use it.
std::optional<Use> use_of(device::HidKind kind);
const char* words(Use use);

// The device with this id. Fails if there is none, and then suggests the nearest id, or if it cannot be
// opened, and then names the remedy.
Result<device::ListedDevice> find(std::span<const device::ListedDevice> there, const std::string& id);

struct Choice {
    std::optional<device::ListedDevice> mover, wheel;
};

// The devices with these ids, at most one per role. Fails as find(), if two have the same role, or if one has
// none.
Result<Choice> choose(std::span<const device::ListedDevice> there, std::span<const std::string> ids);

// The first usable device of each role.
Choice choose_any(std::span<const device::ListedDevice> there);
std::vector<std::string> ids_of(const Choice& choice);

}  // namespace bolt::station_setup
