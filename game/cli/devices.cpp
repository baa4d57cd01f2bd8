// boltwright devices: lists the connected devices and gloves with their capabilities, faults and remedies. It
// opens only a device that is named, because another program may use it, and a serial port may not have a
// glove.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <memory>

#include "content/station/wheel_config_file.hpp"
#include "engine/base/result.hpp"
#include "engine/base/serial_port.hpp"
#include "game/cli/commands.hpp"
#include "game/station/device_check.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/device_thread.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::cli {

namespace {

constexpr double open_timeout = 3.0;  // s
constexpr int device_priority = 70;   // as in a station

struct DevicesOptions {
    std::string device, glove, wheel_config_file;
    bool others = false, yes = false;
    double seconds = 1.0;
};

const char* description_of(device::DeviceKind kind) {
    switch (kind) {
        case device::DeviceKind::arm:
            return "a force-feedback arm; moves the tool and renders its forces";
        case device::DeviceKind::puck:
            return "six axes that spring back; moves the tool, renders no force";
        case device::DeviceKind::open_ffboard:
            return "OpenFFBoard: one axis with a torque; turns the wrench on its bolt";
        case device::DeviceKind::wheel:
            return "a wheel with force feedback: one axis with a torque; turns the wrench on its bolt";
        case device::DeviceKind::other:
            break;
    }
    return "cannot be used for training";
}

std::string device_list(const std::vector<device::ListedDevice>& found) {
    std::string text = "Devices:\n";
    for (const device::ListedDevice& l : found) {
        text += fmt::format("  {}  {}  {}\n    {}\n", l.id, l.name, l.path, description_of(l.kind));
        if (l.error)
            text += fmt::format("    cannot be used{}: {}\n", l.usable() ? " yet" : "", l.error->message());
    }
    if (found.empty())
        text +=
            "  none; connect a force-feedback arm, a SpaceMouse, an OpenFFBoard or a wheel with force "
            "feedback\n";
    else
        text += "  boltwright devices --device ID opens one and shows its capabilities\n";
    return text;
}

std::string port_list(const std::vector<std::filesystem::path>& found) {
    std::string text = "Serial ports for a CyberGlove:\n";
    for (const auto& port : found) {
        const Status access = check_port_access(port);
        text += fmt::format("  {}{}\n", port.string(), access ? "" : "\n    " + access.error().message());
    }
    if (found.empty())
        text += "  none; connect the glove's adapter, or name another port with --glove PATH\n";
    else
        text += "  boltwright devices --glove PATH queries the glove on one\n";
    return text;
}

Result<device::OpenOptions> with_wheel_config(const std::string& file, device::OpenOptions options) {
    if (file.empty()) return options;
    BOLT_TRY_ASSIGN(const auto read, content::load_wheel_config(file));
    options.wheel = read;
    return options;
}

// Opens the device and reads it for options.seconds. Returns its description and its sample rate.
Result<std::string> examine_device(const DevicesOptions& options) {
    BOLT_TRY_ASSIGN(const auto opening, with_wheel_config(options.wheel_config_file, {}));
    BOLT_TRY_ASSIGN(OpenDevice device, open_device(options.device, opening, options.yes));
    device::DeviceThread& thread = device.thread;
    const device::Timer timer = device::steady_timer();
    const std::uint64_t before = thread.snapshot().number;
    timer.wait(options.seconds);
    const auto received = static_cast<double>(thread.snapshot().number - before);
    const device::DeviceStatus& status = thread.status();
    if (status.state != device::DeviceState::usable)
        return fail(
            ErrorCode::no_device,
            status.fault_message.empty() ? device.description->name + " sends nothing" : status.fault_message,
            "a device that sends its state");
    std::string text = fmt::format("{}  {}\n", options.device, device.description->name);
    for (const auto& lines :
         {device::summary_lines(*device.description), device::summary_lines(status.health)})
        for (const std::string& line : lines) text += fmt::format("  {}\n", line);
    if (options.seconds > 0.0)
        text += fmt::format("  sent {:.0f} samples a second{}\n", received / options.seconds,
                            received < 1.0 ? "; it is at rest" : "");
    if (status.malformed_samples > 0)
        text += fmt::format("  {} malformed reports\n", status.malformed_samples);
    return text;
}

// Asks whether the device may push the hand. If not, the options give the reason why its stiffness is not
// measured.
void ask_for_stiffness(const device::Description& d, bool yes, station_setup::DeviceCheckOptions& options) {
    const double force = station_setup::trial_force(d, options.bounds);
    if (force <= 0.0) return;
    options.measures_stiffness = ask(
        fmt::format(
            "{} pushes the hand with {:.1f} N at most, for about {:.0f} s. Hold its handle in the middle of "
            "its reach{}. May it push?",
            d.name, force, station::stiffness_levels * station::stiffness_level_time,
            d.buttons > 0 && options.dead_man != 0
                ? fmt::format(", and its button {}", std::countr_zero(options.dead_man) + 1)
                : ""),
        yes);
    options.why_not_measured = has_terminal()
                                   ? "it may not push the hand"
                                   : "it pushes the hand, which needs permission: use a terminal or --yes";
}

Result<std::string> examine_glove(const std::string& port, double seconds) {
    BOLT_TRY(check_port_access(port));
    hand::GloveDriver driver = hand::GloveDriver::start(port);
    BOLT_TRY(station_setup::wait_for_glove(driver, port));
    const device::Timer timer = device::steady_timer();
    const std::uint64_t before = driver.sample().number;
    timer.wait(seconds);
    const auto received = static_cast<double>(driver.sample().number - before);
    const hand::GloveReport& report = driver.report();
    const hand::GloveIdentity& glove = report.identity;
    std::string text = fmt::format("{}\n  CyberGlove, {} hand, {} sensors{}\n", port,
                                   glove.side == hand::Side::left ? "left" : "right", glove.sensors,
                                   glove.version.empty() ? "" : ", version " + glove.version);
    if (seconds > 0.0) text += fmt::format("  sent {:.0f} samples a second\n", received / seconds);
    if (report.lost_bytes > 0) text += fmt::format("  {} invalid bytes received\n", report.lost_bytes);
    if (report.fault_message[0] != '\0') text += fmt::format("  {}\n", report.fault_message.data());
    if (const std::string warning = station_setup::adapter_warning(port); !warning.empty())
        text += fmt::format("  {}\n", warning);
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
    if (text.empty()) text = device_list(device::list_devices(options.others)) + port_list(serial_ports());
    const Status printed = print(text);
    return printed ? 0 : print_error(printed.error());
}

}  // namespace

Result<OpenDevice> open_device(const std::string& id, device::OpenOptions opening, bool yes) {
    BOLT_TRY(station_setup::find_device(device::list_devices(true), id));
    const device::ArmDialog dialog = terminal_dialog(yes);
    opening.permission = dialog.permission;
    BOLT_TRY_ASSIGN(auto thread,
                    device::DeviceThread::start(device::factory_for(id, opening), {{}, device_priority}));
    BOLT_TRY_ASSIGN(auto description, thread.wait_until_open(open_timeout, dialog.on_preparation));
    return OpenDevice{std::move(thread), std::move(description)};
}

Status check_devices(const station_setup::StationRequest& request, double seconds, bool yes) {
    const content::StationFile& station = request.station;
    for (const std::string& id : request.devices) {
        device::OpenOptions opening;
        station_setup::DeviceCheckOptions options;
        options.seconds = seconds;
        if (station.arm && station.arm->device == id) {
            opening.effector_mass = station.arm->effector_mass;
            options.bounds = station.arm->limits;
            options.dead_man = station.arm->buttons.value_or(station::Buttons{}).dead_man;
        }
        if (station.wheel && station.wheel->device == id) opening.wheel = station.wheel->config;
        BOLT_TRY_ASSIGN(opening, with_wheel_config(request.wheel_config_file, opening));
        BOLT_TRY_ASSIGN(OpenDevice device, open_device(id, opening, yes));
        ask_for_stiffness(*device.description, yes, options);
        catch_interruption();
        options.stop = [] { return interrupted(); };
        BOLT_TRY_ASSIGN(const auto check, station_setup::check_device(device.thread, options));
        BOLT_TRY(print(station_setup::device_check_report(check)));
    }
    return {};
}

std::string devices_line() {
    std::size_t usable = 0, unusable = 0;
    for (const device::ListedDevice& l : device::list_devices()) ++(l.usable() ? usable : unusable);
    const std::size_t found = serial_ports().size();
    std::string text = fmt::format("Devices: {}", usable + unusable);
    if (unusable > 0) text += fmt::format(", {} of them cannot be used", unusable);
    return text +
           fmt::format(", {} serial port{}; details: boltwright devices\n", found, found == 1 ? "" : "s");
}

void add_devices(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DevicesOptions>();
    CLI::App* devices = app.add_subcommand(
        "devices", "List the connected devices with their capabilities, faults and remedies");
    devices->add_option("--device", options->device, "Id of a device to open; shows its capabilities");
    devices
        ->add_option("--rig", options->wheel_config_file,
                     "Configuration file of the wheel: its motor, its encoder")
        ->needs("--device");
    devices
        ->add_flag(
            "--yes,--may-move", options->yes,
            "Permit an arm to move by itself to find its position; without this option the terminal asks. "
            "Keep the room around it free")
        ->needs("--device");
    devices->add_option("--glove", options->glove, "Serial port of a glove to query");
    devices->add_flag("--all", options->others, "List devices of other kinds too, such as keyboards");
    devices->add_option("--seconds", options->seconds, "How long to read the named device or glove")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    devices->callback([options, &exit_code] { exit_code = run_devices(*options); });
}

}  // namespace bolt::cli
