// Station files: any bytes give a station that survives a write and read to the same bits, or an error with a
// position, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/station/station_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto read = bolt::content::parse_station(text, "fuzz.json");
    if (!read) {
        if (read.error().line < 1 || read.error().what.empty()) std::abort();
        return 0;
    }
    if (read->arm) {
        const bolt::content::StationMover& arm = *read->arm;
        const bolt::Quat turn = bolt::content::orientation_of(arm.mounting);
        const bool fits = !arm.device.empty() && glm::length(turn) > 0.999 && glm::length(turn) < 1.001 &&
                          arm.scale.value_or(1.0) >= 0.1 && arm.scale.value_or(1.0) <= 20.0 &&
                          arm.limits.force.value_or(0.0) >= 0.0;
        const bolt::station::Buttons b = arm.buttons.value_or(bolt::station::Buttons{});
        const bool apart =
            (b.dead_man & b.clutch) == 0 && (b.dead_man & b.stop) == 0 && (b.stop & b.reset) == 0;
        if (!fits || !apart) std::abort();
    }
    for (const bolt::content::Registration& one : read->registrations) {
        const double length = glm::length(one.pose.orientation);
        const bool fits = one.from != one.to && length > 0.999 && length < 1.001 &&
                          bolt::finite(one.pose.position) && one.points >= 3 && one.rms >= 0.0 &&
                          one.largest_left_out.value_or(one.rms) > one.rms - 1e-6 &&
                          bolt::content::find_registration(read->registrations, one.to, one.from) == &one;
        if (!fits) std::abort();
    }
    const auto again = bolt::content::parse_station(bolt::content::station_json(*read), "fuzz.json");
    if (!again || *again != *read) std::abort();
    return 0;
}
