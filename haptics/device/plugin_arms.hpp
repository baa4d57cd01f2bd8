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

// The files *.so in `folders`, sorted by name; of two with one name the first.
std::vector<std::filesystem::path> find_plugins(const std::vector<std::filesystem::path>& folders);

// An arm's id: plugin:NAME:INDEX.
std::string plugin_arm_id(const std::filesystem::path& plugin, int index);

// How many arms the plug-in has now, at most 16. Starts the plug-in for that.
Result<int> count_plugin_arms(const std::filesystem::path& plugin);

// Plug-in processes that stay open between two attempts to open an arm, by arm id, so that a calibration
// continues instead of starting again.
class UnfinishedCalibrations;
std::shared_ptr<UnfinishedCalibrations> make_unfinished_calibrations();

struct PluginArmOptions {
    std::filesystem::path plugin;
    int index = 0;          // of the arm, from 0
    bool may_move = false;  // the arm may move by itself to find its position, if it has not done so yet
    std::shared_ptr<UnfinishedCalibrations> waiting{};  // null: an arm that waits for its user is closed
};

// Opens arm `index`. The error has a need (preparation_of()) if the arm would have to move by itself and may
// not, if the user must act, or, with `waiting` and without `may_move`, if it calibrates for longer than half
// a second. With `waiting` the arm stays open in the last two cases and continues its calibration when it is
// opened again.
Result<std::unique_ptr<DeviceDriver>> open_plugin_arm(const PluginArmOptions& options, Timer timer);

}  // namespace bolt::device
