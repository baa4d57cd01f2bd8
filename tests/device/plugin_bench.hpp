// The faulty arm of a plug-in in a folder of its own, which shows the fault that a test names.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "haptics/device/plugin_arms.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"

namespace bolt::test {

using OpenedArm = Result<std::unique_ptr<device::DeviceDriver>>;

inline const std::filesystem::path plugins = BOLT_PLUGINS;

inline void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

// The faulty arm in a folder of its own.
struct PluginBench {
    Folder folder;
    std::filesystem::path plugin = folder / "faulty_arm.so";
    std::shared_ptr<device::UnfinishedCalibrations> unfinished_calibrations =
        device::make_unfinished_calibrations();
    EnvironmentVariable fault_file{"FAULTY_ARM", (folder / "fault").c_str()};

    PluginBench() { std::filesystem::copy_file(plugins / "faulty_arm.so", plugin); }
    // Replaced in one step, because the plug-in reads it at any time.
    void show(const std::string& fault) const {
        write_text(folder / "next", fault);
        std::filesystem::rename(folder / "next", folder / "fault");
    }
    [[nodiscard]] OpenedArm open(bool may_move = false) const {
        return device::open_plugin_arm({plugin, 0, may_move, unfinished_calibrations},
                                       device::steady_timer());
    }
    [[nodiscard]] OpenedArm open_with(const std::string& fault) const {
        show(fault);
        return open();
    }
};

inline std::string message(const OpenedArm& opened) { return opened ? "" : opened.error().message(); }

// Reads until there is an error or 100 samples have come, for a minute at most. Returns the error or the last
// sample.
inline Result<device::Sample> read_many(device::DeviceDriver& device) {
    device::Sample last;
    int samples = 0;
    for (int i = 0; i < 12'000 && samples < 100; ++i) {
        BOLT_TRY_ASSIGN(const std::optional<device::Sample> sample, device.read(0.005));
        if (!sample) continue;
        last = *sample;
        ++samples;
    }
    return last;
}

}  // namespace bolt::test
