// Opens a device for a command, and asks on the terminal for what an arm needs.
#pragma once

#include <memory>
#include <string>

#include "engine/base/result.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/device_thread.hpp"

namespace bolt::cli {

struct OpenDevice {
    device::DeviceThread thread;
    std::shared_ptr<const device::Description> description;
};

// `yes`: the answer to the question whether an arm may move by itself.
Result<OpenDevice> open_device(const std::string& id, device::OpenOptions opening, bool yes);

}  // namespace bolt::cli
