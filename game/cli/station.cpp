// boltwright station: makes a station file from the connected devices, compares a file with them, and tries
// the station.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/format/folders.hpp"
#include "content/station/station_file.hpp"
#include "engine/base/serial_port.hpp"
#include "game/cli/commands.hpp"
#include "game/station/station_check.hpp"
#include "game/station/station_setup.hpp"

namespace bolt::cli {

namespace {

struct StationArguments {
    TrialOptions trial;  // `station_file` is the FILE of every command
    std::string name;
    bool force = false;
};

// The description that the device reports; none: the selection has no device in this role.
Result<std::optional<device::Description>> reported_by(const std::optional<device::ListedDevice>& listed) {
    if (!listed) return std::optional<device::Description>();
    BOLT_TRY_ASSIGN(auto description, station_setup::read_description(listed->id, {}));
    description.id = listed->id;
    return std::optional(std::move(description));
}

Status make_station(const StationArguments& options) {
    const std::filesystem::path file = options.trial.station_file;
    std::error_code ignored;
    if (!options.force && std::filesystem::exists(file, ignored))
        return fail(ErrorCode::usage, fmt::format("{} exists already", file.string()),
                    "a new file, or --force to overwrite it");
    const std::vector<device::ListedDevice> connected = device::list_devices(true);
    station_setup::DeviceSelection selection = station_setup::select_any_devices(connected);
    if (!options.trial.devices.empty()) {
        BOLT_TRY_ASSIGN(auto named, station_setup::select_devices(connected, options.trial.devices));
        selection = std::move(named);
    }
    if (!selection.mover && !selection.wheel && options.trial.glove.empty())
        return fail(ErrorCode::no_device, "no device is connected that a station can use",
                    "one that `boltwright devices` lists, or --glove PORT");
    BOLT_TRY_ASSIGN(const auto mover, reported_by(selection.mover));
    BOLT_TRY_ASSIGN(const auto wheel, reported_by(selection.wheel));
    if (!options.trial.glove.empty()) BOLT_TRY(check_port_access(options.trial.glove));
    content::StationFile station =
        station_setup::station_of(mover ? &*mover : nullptr, wheel ? &*wheel : nullptr);
    station.name = options.name;
    station.glove_port = options.trial.glove;
    const std::filesystem::path schema = content::content_folder() / "schema" / "station.schema.json";
    if (std::filesystem::exists(schema, ignored)) station.schema = schema.string();
    BOLT_TRY(content::save_station(file, station));
    std::string text = file.string() + ":\n";
    if (mover) text += fmt::format("  arm    {}  {}\n", mover->id, mover->name);
    if (wheel) text += fmt::format("  wheel  {}  {}\n", wheel->id, wheel->name);
    if (!station.glove_port.empty()) text += fmt::format("  glove  {}\n", station.glove_port);
    return print(text +
                 "Enter how the devices are mounted; an editor that reads its schema explains every "
                 "member. Then: boltwright station check\n");
}

int check_station(const std::string& file) {
    const Result<content::StationFile> station = content::load_station(file);
    if (!station) return print_error(station.error());
    const std::vector<station_setup::StationFinding> findings =
        station_setup::compare(*station, station_setup::find_facts(*station));
    const bool problem = !findings.empty() && findings.front().prevents_use;  // these come first
    const Status printed =
        print(station_setup::describe(findings) +
              (problem ? "This station cannot be used as the file says\n" : "The file suits the devices\n"));
    if (!printed) return print_error(printed.error());
    return problem ? static_cast<int>(ErrorCode::failed) : 0;
}

CLI::App* add_command(CLI::App& station, StationArguments& options, const char* name,
                      const char* description) {
    CLI::App* command = station.add_subcommand(name, description);
    command->add_option("FILE", options.trial.station_file, "The station file")->required();
    return command;
}

void add_new(CLI::App& station, const std::shared_ptr<StationArguments>& options, int& exit_code) {
    CLI::App* made = add_command(station, *options, "new",
                                 "Write a file for the connected devices, with the values that they report");
    made->add_option("--device", options->trial.devices,
                     "Id of a device, as listed by `boltwright devices`; may be given twice, for one that "
                     "moves the tool and one that turns the wrench; default: the first of each")
        ->expected(1)
        ->take_all();
    made->add_option("--glove", options->trial.glove, "Serial port of a glove");
    made->add_option("--name", options->name, "Name of the station, such as the room");
    made->add_flag("--force", options->force, "Overwrite an existing file");
    made->callback([options, &exit_code] {
        const Status done = make_station(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

void add_try(CLI::App& station, const std::shared_ptr<StationArguments>& options, int& exit_code) {
    TrialOptions& trial = options->trial;
    CLI::App* tried = add_command(station, *options, "try",
                                  "Run the station and assess whether it is good enough for training (exit "
                                  "code 0) or not (1), as `boltwright doctor --station`");
    tried->add_option("--assembly", trial.assembly, "Assembly that the servo simulates: folder, file or name")
        ->capture_default_str();
    tried->add_option("--trainee", trial.trainee,
                      "Wearer of the glove, with a calibration made by `boltwright glove`");
    tried->add_option("--folder", trial.calibrations,
                      "Folder of calibrations; default: the user's data folder");
    tried->add_option("--seconds", trial.seconds, "Duration of the trial")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    tried->add_flag("--yes", trial.yes,
                    "Permit arms to move by themselves; without this option the terminal asks");
    tried->callback([options, &exit_code] { exit_code = try_station(options->trial); });
}

}  // namespace

void add_station(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<StationArguments>();
    CLI::App* station = app.add_subcommand(
        "station",
        "Make, check or try the file that describes the devices of a workplace, and measure where they are");
    station->require_subcommand(1);
    add_new(*station, options, exit_code);
    CLI::App* checked = add_command(*station, *options, "check",
                                    "Compare a file with the connected devices: exit code 0 if it suits "
                                    "them, 1 if it does not, 3 if the file is wrong");
    checked->callback([options, &exit_code] { exit_code = check_station(options->trial.station_file); });
    add_try(*station, options, exit_code);
    add_station_register(*station, exit_code);
}

}  // namespace bolt::cli
