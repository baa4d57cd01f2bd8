// Messages of Haply's service: any bytes give plausible values or an error with a text, never a crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "haptics/device/haply_messages.hpp"

namespace {

using namespace bolt;
using namespace bolt::device;

bool is_plausible(const HaplyState& state) {
    const bool unit = !state.orientation || std::abs(glm::length(*state.orientation) - 1.0) < 1e-9;
    return unit && glm::length(state.position) <= 1.0 && glm::length(state.velocity) <= 50.1 &&
           state.buttons <= 7;
}

// A force for the arm must be a message with one string for the id.
bool is_safe(const HaplyArmEntry& arm) {
    return !arm.id.empty() && arm.id.find_first_of("\"\\\n") == std::string::npos &&
           haply_force_message(arm, Vec3(1.0), false).size() < 300;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const HaplyArmEntry arm{"049D", true, Vec3(0.0, -0.12, 0.15)};
    const HaplyGripEntry wireless{"61576", true}, wired{"61576", false};
    for (const HaplyGripEntry* grip : {&wireless, &wired, static_cast<const HaplyGripEntry*>(nullptr)}) {
        const auto state = parse_haply_state(text, arm, grip);
        if (state ? !is_plausible(*state) : state.error().what.empty()) std::abort();
    }
    const auto inventory = parse_haply_inventory(text);
    if (!inventory && inventory.error().expected.empty()) std::abort();
    if (inventory)
        for (const HaplyArmEntry& one : inventory->arms)
            if (!is_safe(one)) std::abort();
    (void)loss_in_haply_event(text, arm);
    (void)is_old_haply_version(text);
    return 0;
}
