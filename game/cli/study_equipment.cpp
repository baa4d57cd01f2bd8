// The checks that this computer has the devices and displays that the lessons of a study need.
#include <fmt/format.h>

#include <algorithm>

#include "content/displays/check_displays.hpp"
#include "engine/base/serial_port.hpp"
#include "engine/platform/window.hpp"
#include "engine/xr/headset.hpp"
#include "game/cli/commands.hpp"
#include "game/station/station_setup.hpp"
#include "game/view/walls.hpp"

namespace bolt::cli {

namespace {

// Fails if these devices cannot be used together.
Status usable_devices(const std::vector<std::string>& ids) {
    static const std::vector<device::ListedDevice> connected = device::list_devices();
    const std::string& first = ids.front();
    if (ids.size() == 1 && (first == "mouse" || first == "simulated" || first == "simulated-arm")) return {};
    BOLT_TRY(station_setup::select_devices(connected, ids));
    return {};
}

// Searches once, because a runtime may take seconds to start.
Status usable_headset() {
    static const Status found = [] {
        xr::Headset headset({});
        return headset.find(0.0) ? Status() : Status(fail(*headset.absence()));
    }();
    return found;
}

Status usable_walls(const std::string& file) {
    const content::LoadedDisplays loaded = content::load_displays(file);
    if (!loaded.ok()) {
        // The place in the display file belongs to the message, because the error itself is in the plan.
        const Error& error = loaded.errors.front();
        Error shown = error;
        shown.expected.clear();
        return fail(error.code, shown.message(), error.expected);
    }
    BOLT_TRY_ASSIGN(const auto desktop, platform::Desktop::open());
    const auto findings = content::check_displays(loaded.displays, view::this_host(desktop));
    if (findings.empty() || !findings.front().prevents_use) return {};
    return fail(ErrorCode::bad_content,
                fmt::format("{}: the walls cannot be shown: {}", file, findings.front().text),
                "a display file without mistakes for these monitors");
}

Status usable_glove(const std::string& port) {
    if (port != "auto") return check_port_access(port);
    if (!serial_ports().empty()) return {};
    return fail(ErrorCode::no_device, "no glove is connected", "a CyberGlove at a serial port");
}

}  // namespace

study::EquipmentCheck equipment_check() {
    return {usable_devices, usable_headset, usable_walls, usable_glove};
}

}  // namespace bolt::cli
