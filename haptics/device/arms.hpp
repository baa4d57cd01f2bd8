// Arms through their vendors' libraries or services, and through plug-ins: one row for each backend, with the
// functions that list its arms and open one of them.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "haptics/device/connected_devices.hpp"

namespace bolt::device {

struct ArmBackend {
    std::string_view name;  // an arm's id is NAME:INDEX, or NAME:PLUG-IN:INDEX
    // Returns the arms that are connected now; none if the backend's library is absent, because a computer
    // without an arm needs none. A library that cannot be used is listed as an arm with an error.
    std::vector<ListedDevice> (*list)();
    Result<std::unique_ptr<DeviceDriver>> (*open)(const ListedDevice& listed, const OpenOptions& options);
};

std::span<const ArmBackend> arm_backends();

// The index in an arm's id: 3 for force-dimension:3.
int arm_index(std::string_view id);

}  // namespace bolt::device
