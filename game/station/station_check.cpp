#include "game/station/station_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "content/format/folders.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/serial_port.hpp"
#include "game/station/frame_registration.hpp"
#include "haptics/device/device_thread.hpp"

namespace bolt::station_setup {

namespace {

constexpr double description_timeout = 3.0;  // s

// Adds a warning for each bound that is above the device's own limit.
void compare_limits(const force::LimitBounds& bounds, const device::Description& reported,
                    std::vector<StationFinding>& findings) {
    const auto check = [&](const char* key, const std::optional<double>& bound, double own) {
        if (bound && *bound > own)
            findings.push_back(
                {false, fmt::format("the limit {} is {:g}, above the device's own {:g}: it has no effect",
                                    key, *bound, own)});
    };
    const force::OutputLimits& own = reported.limits;
    const bool force = station::renders_force(reported), torque = station::renders_torque(reported);
    check("force_N", bounds.force, force ? own.force : 0.0);
    check("torque_Nm", bounds.torque, torque ? own.torque : 0.0);
    check("stiffness_N_per_m", bounds.stiffness, force ? own.stiffness : 0.0);
    check("torsion_Nm_per_rad", bounds.torsion, torque ? own.torsion : 0.0);
    check("damping_Ns_per_m", bounds.damping, force ? own.damping : 0.0);
    check("angular_damping_Nms_per_rad", bounds.angular_damping, torque ? own.angular_damping : 0.0);
}

void compare_buttons(const std::optional<station::Buttons>& given, const device::Description& reported,
                     std::vector<StationFinding>& findings) {
    const auto count = static_cast<std::uint32_t>(std::max(reported.buttons, 0));
    const std::uint32_t present = count >= 32 ? ~0U : (1U << count) - 1U;
    const station::Buttons buttons = given.value_or(station::Buttons{});
    const auto check = [&](const char* key, std::uint32_t mask) {
        for (std::uint32_t missing = mask & ~present; missing != 0; missing &= missing - 1)
            findings.push_back({true, fmt::format("the button \"{}\" is number {}, and the device has {}",
                                                  key, std::countr_zero(missing) + 1,
                                                  count == 0   ? "none"
                                                  : count == 1 ? "one button"
                                                               : fmt::format("{} buttons", count))});
    };
    if (given) {
        check("dead_man", buttons.dead_man);
        check("clutch", buttons.clutch);
        check("stop", buttons.stop);
        check("reset", buttons.reset);
    }
    const bool forces = station::renders_force(reported) || station::renders_torque(reported);
    if (forces && (buttons.dead_man & present) == 0 && !reported.senses_gripper)
        findings.push_back({false, "no button switches the forces on: in a lesson the space bar does"});
}

}  // namespace

std::vector<StationFinding> compare(const content::StationMover& arm, const device::Description& reported) {
    std::vector<StationFinding> findings;
    compare_buttons(arm.buttons, reported, findings);
    compare_limits(arm.limits, reported, findings);
    if (reported.sensing == device::Sensing::velocity && (arm.scale || arm.power_ratio))
        findings.push_back({false, "scale and power have no effect: the device senses a velocity"});
    return findings;
}

std::vector<StationFinding> compare(const content::StationWheel& wheel, const device::Description& reported) {
    std::vector<StationFinding> findings;
    compare_buttons(wheel.buttons, reported, findings);
    return findings;
}

std::vector<StationFinding> compare(const content::StationFile& station, const StationFacts& facts) {
    std::vector<StationFinding> findings;
    const auto add = [&](const auto& device, const auto& reported, const char* name) {
        if (!device || !reported) return;
        if (!*reported) {
            findings.push_back({true, fmt::format("{}: {}", name, reported->error().message())});
            return;
        }
        for (StationFinding& finding : compare(*device, **reported))
            findings.push_back({finding.prevents_use, fmt::format("{}: {}", name, finding.text)});
    };
    add(station.arm, facts.arm, "arm");
    add(station.wheel, facts.wheel, "wheel");
    if (!facts.glove) findings.push_back({true, "glove: " + facts.glove.error().message()});
    if (station.wrist_tracker && !registration_from(station.registrations, content::CoordinateFrame::hand,
                                                    content::CoordinateFrame::wrist_tracker))
        findings.push_back(
            {false, fmt::format("glove: the wrist is not registered with the Vive tracker {}, so "
                                "it does not move the hand; expected a registration by "
                                "`boltwright station register --hand SIDE --trainee NAME`",
                                name(*station.wrist_tracker))});
    for (const content::Registration& one : station.registrations)
        if (const auto unused = unused_registration(one.from, one.to))
            findings.push_back({false, unused->message()});
    if (station.arm && !station.arm->tool.empty()) {
        const std::string& tool = station.arm->tool;
        const std::string near = nearest(tool, facts.tools);
        if (std::find(facts.tools.begin(), facts.tools.end(), tool) == facts.tools.end())
            findings.push_back({true, fmt::format("arm: no assembly has a tool \"{}\"; {}", tool,
                                                  near.empty() ? fmt::format("expected one of {}",
                                                                             fmt::join(facts.tools, ", "))
                                                               : fmt::format("did you mean \"{}\"?", near))});
    }
    std::stable_partition(findings.begin(), findings.end(),
                          [](const StationFinding& finding) { return finding.prevents_use; });
    return findings;
}

std::string describe(std::span<const StationFinding> findings) {
    std::string text;
    for (const StationFinding& finding : findings)
        text += fmt::format("  {}{}\n", finding.prevents_use ? "" : "warning: ", finding.text);
    return text;
}

Result<device::Description> read_description(const std::string& id, const device::WheelConfig& config) {
    BOLT_TRY_ASSIGN(auto thread, device::DeviceThread::start(device::factory_for(id, {config})));
    BOLT_TRY_ASSIGN(const auto description, thread.wait_until_open(description_timeout));
    return *description;
}

StationFacts find_facts(const content::StationFile& station) {
    StationFacts facts;
    const std::vector<device::ListedDevice> connected = device::list_devices(true);
    const auto find = [&](const std::string& id,
                          const device::WheelConfig& config) -> Result<device::Description> {
        BOLT_TRY(find_device(connected, id));
        std::vector<std::string> ids{id};
        BOLT_TRY(add_devices_of(station, connected, ids));
        return read_description(id, config);
    };
    if (station.arm) facts.arm = find(station.arm->device, {});
    if (station.wheel) facts.wheel = find(station.wheel->device, station.wheel->config);
    if (!station.glove_port.empty()) facts.glove = check_port_access(station.glove_port);
    for (const std::string& name : content::assembly_names()) {
        const content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder(name));
        if (!loaded.ok()) continue;
        for (const content::Tool& tool : loaded.assembly.tools) facts.tools.push_back(tool.name);
    }
    std::sort(facts.tools.begin(), facts.tools.end());
    facts.tools.erase(std::unique(facts.tools.begin(), facts.tools.end()), facts.tools.end());
    return facts;
}

namespace {

station::Buttons buttons_of(const device::Description& reported) {
    const station::Buttons usual;
    return {reported.buttons >= 1 ? usual.dead_man : 0, reported.buttons >= 2 ? usual.clutch : 0, 0, 0};
}

}  // namespace

content::StationFile station_of(const device::Description* mover, const device::Description* wheel) {
    content::StationFile station;
    if (mover != nullptr) {
        content::StationMover& arm = station.arm.emplace();
        arm.device = mover->id;
        arm.buttons = buttons_of(*mover);
        if (station::renders_force(*mover)) {
            arm.limits.force = mover->limits.force;
            if (mover->limits.stiffness >= content::min_stiffness)
                arm.limits.stiffness = mover->limits.stiffness;
        }
        if (station::renders_torque(*mover)) arm.limits.torque = mover->limits.torque;
    }
    if (wheel != nullptr) {
        content::StationWheel& turner = station.wheel.emplace();
        turner.device = wheel->id;
        turner.buttons = buttons_of(*wheel);
    }
    return station;
}

}  // namespace bolt::station_setup
