#include "haptics/device/arms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "haptics/device/force_dimension.hpp"
#include "haptics/device/haply.hpp"
#include "haptics/device/open_haptics.hpp"
#include "haptics/device/plugin/arm_process.hpp"
#include "haptics/device/plugin_arms.hpp"

namespace bolt::device {

namespace {

constexpr int max_arms = 16;  // of one backend

// The entry of a library that is present and cannot be used.
ListedDevice unusable_arm(std::string_view vendor, const char* name, Error error) {
    error.code = ErrorCode::no_device;
    return {{}, fmt::format("{}:0", vendor), name, DeviceKind::arm, std::move(error)};
}

std::vector<ListedDevice> list_force_dimension() {
    std::vector<ListedDevice> arms;
    const char* const name = "Force Dimension arm";
    const Result<ForceDimensionApi> api = load_force_dimension(force_dimension_libraries());
    if (!api) {
        if (api.error().code != ErrorCode::no_device)
            arms.push_back(unusable_arm("force-dimension", name, api.error()));
        return arms;
    }
    const int count = std::clamp(api->get_device_count(), 0, max_arms);
    for (int i = 0; i < count; ++i)
        arms.push_back(
            {api->library.string(), fmt::format("force-dimension:{}", i), name, DeviceKind::arm, {}});
    return arms;
}

Result<std::unique_ptr<DeviceDriver>> open_listed_force_dimension(const ListedDevice& listed,
                                                                  const OpenOptions& options) {
    BOLT_TRY_ASSIGN(auto api, load_force_dimension({listed.path}));
    return open_force_dimension(api, {arm_index(listed.id), options.arm_may_move, options.effector_mass},
                                steady_timer());
}

// The vendor's library finds an arm only by reserving it, so one arm is listed if the library is present.
std::vector<ListedDevice> list_open_haptics() {
    const char* const name = "OpenHaptics arm";
    const Result<OpenHapticsApi> api = load_open_haptics(open_haptics_libraries());
    if (api) return {{api->library.string(), "openhaptics:0", name, DeviceKind::arm, {}}};
    if (api.error().code == ErrorCode::no_device) return {};
    return {unusable_arm("openhaptics", name, api.error())};
}

Result<std::unique_ptr<DeviceDriver>> open_listed_open_haptics(const ListedDevice& listed,
                                                               const OpenOptions& /*options*/) {
    BOLT_TRY_ASSIGN(const auto api, load_open_haptics({listed.path}));
    return open_open_haptics(api, steady_timer());
}

// Short, because every listing of devices tries to connect, also on computers without a service.
constexpr double haply_list_timeout = 0.1;  // s

std::vector<ListedDevice> list_haply_arms() {
    std::vector<ListedDevice> arms;
    const char* const name = "Haply Inverse3";
    const Result<HaplyService> service = haply_service();
    const auto found = service ? list_haply(*service, haply_list_timeout)
                               : Result<std::vector<HaplyListing>>(fail(service.error()));
    if (!found) return {unusable_arm("haply", name, found.error())};
    for (const HaplyListing& arm : *found)
        arms.push_back({service->states.text(), fmt::format("haply:{}", arms.size()),
                        fmt::format("{} {}", name, arm.arm), DeviceKind::arm, arm.error});
    return arms;
}

Result<std::unique_ptr<DeviceDriver>> open_listed_haply(const ListedDevice& listed, const OpenOptions&) {
    BOLT_TRY_ASSIGN(const HaplyService service, haply_service());
    return open_haply(service, arm_index(listed.id), steady_timer());
}

std::vector<ListedDevice> list_plugin_arms() {
    std::vector<ListedDevice> arms;
    for (const std::filesystem::path& plugin : find_plugins(plugin_folders())) {
        const std::string name = plugin_name(plugin) + ", an arm of a plug-in";
        const Result<int> count = count_plugin_arms(plugin);
        const auto entry = [&](int index, std::optional<Error> error) {
            arms.push_back({plugin.string(), plugin_arm_id(plugin, index), name, DeviceKind::arm, error});
        };
        if (!count) entry(0, count.error());
        for (int i = 0; count && i < *count; ++i) entry(i, {});
    }
    return arms;
}

Result<std::unique_ptr<DeviceDriver>> open_listed_plugin_arm(const ListedDevice& listed,
                                                             const OpenOptions& options) {
    return open_plugin_arm(
        {listed.path, arm_index(listed.id), options.arm_may_move, options.unfinished_calibrations},
        steady_timer());
}

constexpr std::array backends{
    ArmBackend{"force-dimension", list_force_dimension, open_listed_force_dimension},
    ArmBackend{"openhaptics", list_open_haptics, open_listed_open_haptics},
    ArmBackend{"haply", list_haply_arms, open_listed_haply},
    ArmBackend{"plugin", list_plugin_arms, open_listed_plugin_arm},
};

}  // namespace

std::span<const ArmBackend> arm_backends() { return backends; }

int arm_index(std::string_view id) {
    int index = 0;
    const std::string_view digits = id.substr(std::min(id.size(), id.rfind(':') + 1));
    std::from_chars(digits.data(), digits.data() + digits.size(), index);
    return index;
}

}  // namespace bolt::device
