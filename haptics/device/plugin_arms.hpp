// Arms of plug-ins (boltwright_arm.h): anybody can add one without our sources. Each plug-in runs in a
// process of its own; what it reports is checked and clamped here.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::device {

// The folders of $BOLTWRIGHT_ARM_PLUGINS, the user's and the system's, in the order in which they are
// searched.
std::vector<std::filesystem::path> plugin_folders();

// The files *.so in `folders`, sorted by name; the first of those with the same name.
std::vector<std::filesystem::path> find_plugins(const std::vector<std::filesystem::path>& folders);

// An arm's id: plugin:NAME:INDEX.
std::string plugin_arm_id(const std::filesystem::path& plugin, int index);

// Starts the plug-in and returns the number of its arms now, at most 16.
Result<int> count_plugin_arms(const std::filesystem::path& plugin);

// Plug-in processes that stay open between two attempts to open an arm, by arm id, so that a calibration
// continues instead of starting again.
class UnfinishedCalibrations;
std::shared_ptr<UnfinishedCalibrations> make_unfinished_calibrations();

struct PluginArmOptions {
    std::filesystem::path plugin;
    int index = 0;          // of the arm, from 0
    bool may_move = false;  // the arm may move by itself to find its position, if it has not done so yet
    std::shared_ptr<UnfinishedCalibrations>
        unfinished_calibrations{};  // null: an arm that waits for its user is closed
};

// Opens arm `index`. The error has a need (preparation_of()) in these cases:
// - permission: the arm must move by itself, and `may_move` is false;
// - user: the user must act;
// - wait: the arm still calibrates after 0.5 s. Without `unfinished_calibrations`, or with `may_move`, the
//   call does not return then, but waits up to 90 s.
// With the needs user and wait, the arm stays open in `unfinished_calibrations` and continues its calibration
// at the next opening.
Result<std::unique_ptr<DeviceDriver>> open_plugin_arm(const PluginArmOptions& options, Timer timer);

}  // namespace bolt::device
