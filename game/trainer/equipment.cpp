#include "game/trainer/equipment.hpp"

#include <algorithm>

#include "engine/base/serial_port.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/device/device.hpp"

namespace bolt::trainer {

namespace {

std::string name_of(const station_setup::DeviceSelection& selection) {
    std::string name = selection.mover ? selection.mover->name : std::string();
    if (selection.wheel) name += (name.empty() ? "" : " + ") + selection.wheel->name;
    return name;
}

}  // namespace

std::vector<DeviceOption> device_options(const Equipment& chosen) {
    Equipment free;
    free.hand = HandMode::free;
    std::vector<DeviceOption> options{{{}, {}}, {{}, free}};
    const std::vector<device::ListedDevice> connected = device::list_devices();
    const station_setup::DeviceSelection all = station_setup::select_any_devices(connected);
    const auto add = [&](const station_setup::DeviceSelection& selection) {
        Equipment equipment;
        equipment.devices = station_setup::ids_of(selection);
        const bool listed = std::any_of(options.begin(), options.end(), [&](const DeviceOption& option) {
            return option.equipment.devices == equipment.devices;
        });
        if (!listed) options.push_back({name_of(selection), equipment});
    };
    if (all.mover) add({all.mover, std::nullopt});
    if (all.wheel) add({std::nullopt, all.wheel});
    if (all.mover && all.wheel) add(all);
    if (const auto selection = station_setup::select_devices(connected, chosen.devices)) add(*selection);
    if (chosen.hand == HandMode::tracked) offer_tracked_hand(options);
    return options;
}

void offer_tracked_hand(std::vector<DeviceOption>& options) {
    const bool offered = std::any_of(options.begin(), options.end(), [](const DeviceOption& option) {
        return option.equipment.hand == HandMode::tracked;
    });
    if (offered) return;
    Equipment tracked;
    tracked.hand = HandMode::tracked;
    options.push_back({{}, tracked});
}

Equipment equipment_for(const std::vector<std::string>& devices, bool free, Equipment base) {
    const std::string first = devices.empty() ? std::string() : devices.front();
    if (!first.empty()) {
        base.devices.clear();
        base.hand = HandMode::helped;
    }
    if (first == "simulated")
        base.hand = HandMode::keyboard;
    else if (first == "simulated-arm")
        base.hand = HandMode::simulated_arm;
    else if (!first.empty() && first != "mouse")
        base.devices = devices;
    if (free && base.devices.empty() && base.hand == HandMode::helped) base.hand = HandMode::free;
    return base;
}

void use_glove(const std::string& glove, Equipment& equipment) {
    if (glove.empty()) return;
    equipment.glove = glove == "none" ? std::string() : glove;
    if (glove != "auto") return;
    const auto ports = serial_ports();
    equipment.glove = ports.empty() ? std::filesystem::path(glove) : ports.front();
}

Equipment default_equipment() {
    Equipment equipment;
    const station_setup::DeviceSelection all = station_setup::select_any_devices(device::list_devices());
    if (all.mover) equipment.devices = station_setup::ids_of(all);
    return equipment;
}

}  // namespace bolt::trainer
