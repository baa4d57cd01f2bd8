// The process of a plug-in (boltwright_arm.h): loads it and answers the calls of the program that started it.
// A plug-in that crashes or hangs ends this process only.
#pragma once

#include <cstdint>
#include <filesystem>

#include "haptics/device/plugin/boltwright_arm.h"

namespace bolt::device {

enum class PluginCall : std::uint32_t { count, open, info, calibrate, enable, exchange };

// Packets between the program and the process. Both sides are of one build, so the layout needs no version.
struct PluginRequest {
    PluginCall call = PluginCall::count;
    std::int32_t argument = 0;  // index of open(), may_move of calibrate(), on of enable()
    bw_arm_command_v1 command{};
};

struct PluginReply {
    PluginCall call = PluginCall::count;
    std::int32_t result = 0;  // what the function returned; open(): BW_ARM_DONE or BW_ARM_ERROR
    bw_arm_info_v1 info{};
    bw_arm_state_v1 state{};
    char text[256] = {};      // last_error, or why the plug-in cannot be used
    char expected[256] = {};  // Error::expected; set only if the plug-in cannot be used
};

// Loads the plug-in and answers requests on the socket until its other end is closed; then releases the arm
// and ends the process. The plug-in must be called by the first thread of the process.
[[noreturn]] void run_arm_host(const std::filesystem::path& plugin, int socket);

}  // namespace bolt::device
