// Backends for arms: the vendors' libraries and services, and plug-ins. Each backend has a function that
// lists its arms and one that opens an arm.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "haptics/device/connected_devices.hpp"

namespace bolt::device {

struct ArmBackend {
    std::string_view name;  // begins the ids of its arms: NAME:INDEX, or plugin:NAME_OF_PLUG_IN:INDEX
    // Returns the arms that are connected now. An absent library gives an empty list, not an error, because a
    // computer without an arm needs no library. A library that cannot be used is listed as an arm with an
    // error.
    std::vector<ListedDevice> (*list)();
    Result<std::unique_ptr<DeviceDriver>> (*open)(const ListedDevice& listed, const OpenOptions& options);
};

std::span<const ArmBackend> arm_backends();

// The index in an arm's id: 3 for force-dimension:3.
int arm_index(std::string_view id);

}  // namespace bolt::device
