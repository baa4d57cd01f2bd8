// boltwright devices: what is plugged in that a hand can hold or wear, what it can, what is wrong with it and
// how to mend that. What is not named is looked at and not opened: somebody may be at work with it, and what
// hangs on a serial port may be no glove.
#include "game/cli/devices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "content/station/wheel_config_file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/device_thread.hpp"
#include "haptics/device/hid_devices.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::cli {

namespace {

constexpr double device_patience = 3.0;  // s

struct DevicesOptions {
    std::string device, glove, rig;
    bool others = false;
    double seconds = 1.0;
};

const char* name_of(device::HidKind kind) {
    switch (kind) {
        case device::HidKind::puck:
            return "six axes that spring back; moves the tool, renders no force";
        case device::HidKind::board:
            return "OpenFFBoard: one axis with a torque; turns the wrench on its bolt";
        case device::HidKind::wheel:
            return "a wheel with force feedback: one axis with a torque; turns the wrench on its bolt";
        case device::HidKind::other:
            break;
    }
    return "nothing to train with";
}

std::string listed(const std::vector<device::ListedDevice>& found) {
    std::string text = "Devices to hold:\n";
    for (const device::ListedDevice& l : found) {
        text += fmt::format("  {}  {}  {}\n    {}\n", l.id, l.name, l.path, name_of(l.kind));
        if (l.trouble) text += fmt::format("    cannot be used: {}\n", l.trouble->message());
    }
    if (found.empty())
        text +=
            "  none by USB: a SpaceMouse, an OpenFFBoard or a wheel with force feedback would be listed "
            "here\n";
    else
        text += "  boltwright devices --device ID opens one and says what it can\n";
    return text;
}

std::string ports(const std::vector<std::filesystem::path>& found) {
    std::string text = "Serial ports, which a CyberGlove may be on:\n";
    for (const auto& port : found) {
        const Status may = hand::check_port_access(port);
        text += fmt::format("  {}{}\n", port.string(), may ? "" : "\n    " + may.error().message());
    }
    if (found.empty())
        text +=
            "  none: plug in the glove's adapter; a port of another name can be given with --glove PATH\n";
    else
        text += "  boltwright devices --glove PATH asks what is on one\n";
    return text;
}

// Opens it and hears what it says for a while.
Result<std::string> examine_device(const DevicesOptions& options) {
    BOLT_TRY(station_setup::find(device::list_devices(true), options.device));
    device::WheelConfig rig;
    if (!options.rig.empty()) {
        BOLT_TRY_ASSIGN(const auto read, content::load_wheel_config(options.rig));
        rig = read;
    }
    BOLT_TRY_ASSIGN(auto line, device::DeviceThread::start(device::factory_for(options.device, rig)));
    BOLT_TRY_ASSIGN(const auto description, line.wait_until_open(device_patience));
    const device::Timer timer = device::steady_timer();
    const std::uint64_t before = line.snapshot().number;
    timer.wait(options.seconds);
    const auto heard = static_cast<double>(line.snapshot().number - before);
    const device::DeviceReport& report = line.report();
    if (report.state != device::DeviceState::usable)
        return fail(ErrorCode::no_device,
                    report.trouble.empty() ? (description)->name + " says nothing" : report.trouble);
    std::string text = fmt::format("{}  {}\n", options.device, (description)->name);
    for (const std::string& words : device::summary_lines(*description)) text += fmt::format("  {}\n", words);
    if (options.seconds > 0.0)
        text += fmt::format("  said where it is {:.0f} times a second just now{}\n", heard / options.seconds,
                            heard < 1.0 ? ": it rests" : "");
    if (report.malformed > 0) text += fmt::format("  {} of its reports make no sense\n", report.malformed);
    return text;
}

Result<std::string> examine_glove(const std::string& port, double seconds) {
    BOLT_TRY(hand::check_port_access(port));
    hand::GloveDriver driver = hand::GloveDriver::start(port);
    BOLT_TRY(station_setup::await_glove(driver, port));
    const device::Timer timer = device::steady_timer();
    const std::uint64_t before = driver.sample().number;
    timer.wait(seconds);
    const auto heard = static_cast<double>(driver.sample().number - before);
    const hand::GloveReport& report = driver.report();
    const hand::GloveIdentity& glove = report.identity;
    std::string text = fmt::format("{}\n  CyberGlove, {} hand, {} sensors{}\n", port,
                                   glove.hand == hand::Side::left ? "left" : "right", glove.sensors,
                                   glove.version.empty() ? "" : ", version " + glove.version);
    if (seconds > 0.0) text += fmt::format("  {:.0f} samples a second just now\n", heard / seconds);
    if (report.lost_bytes > 0)
        text += fmt::format("  {} bytes on the line made no sense\n", report.lost_bytes);
    if (report.trouble[0] != '\0') text += fmt::format("  {}\n", report.trouble.data());
    if (const std::string about = station_setup::about_adapter(port); !about.empty())
        text += fmt::format("  {}\n", about);
    return text;
}

int run_devices(const DevicesOptions& options) {
    std::string text;
    if (!options.device.empty()) {
        const Result<std::string> found = examine_device(options);
        if (!found) return print_error(found.error());
        text += *found;
    }
    if (!options.glove.empty()) {
        const Result<std::string> found = examine_glove(options.glove, options.seconds);
        if (!found) return print_error(found.error());
        text += *found;
    }
    if (text.empty()) text = listed(device::list_devices(options.others)) + ports(hand::serial_ports());
    const Status said = print(text);
    return said ? 0 : print_error(said.error());
}

}  // namespace

std::string devices_line() {
    std::size_t usable = 0, troubled = 0;
    for (const device::ListedDevice& l : device::list_devices()) ++(l.trouble ? troubled : usable);
    const std::size_t found = hand::serial_ports().size();
    std::string text = fmt::format("Devices: {} by USB to hold", usable + troubled);
    if (troubled > 0) text += fmt::format(", {} of them cannot be used", troubled);
    return text +
           fmt::format(", {} serial port{}; boltwright devices says more\n", found, found == 1 ? "" : "s");
}

void add_devices(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DevicesOptions>();
    CLI::App* devices = app.add_subcommand(
        "devices", "Say which devices are there, what they can, what is wrong with them and how to mend it");
    devices->add_option("--device", options->device, "Open this one, by its id, and say what it can");
    devices
        ->add_option("--rig", options->rig, "What this rig file says of that device: its motor, its encoder")
        ->needs("--device");
    devices->add_option("--glove", options->glove, "Ask the glove on this serial port what it is");
    devices->add_flag("--all", options->others, "List keyboards and the like too");
    devices->add_option("--seconds", options->seconds, "how long a named one is listened to")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    devices->callback([options, &exit_code] { exit_code = run_devices(*options); });
}

}  // namespace bolt::cli
