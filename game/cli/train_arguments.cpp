#include "game/cli/train_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "content/station/station_file.hpp"
#include "engine/base/serial_port.hpp"
#include "game/station/station_setup.hpp"
#include "game/view/camera.hpp"
#include "game/view/immersive_frame.hpp"

namespace bolt::cli {

namespace {

bool is_keyword(const std::string& device) {
    return device == "auto" || device == "mouse" || device == "simulated" || device == "simulated-arm";
}

// Adds the station file to the equipment; devices that the command line names have precedence.
Status add_station_file(const TrainArguments& options, trainer::Equipment& equipment) {
    BOLT_TRY_ASSIGN(const auto station, content::load_station(options.station_file));
    const bool keyword = !options.devices.empty() && is_keyword(options.devices.front());
    if (keyword && options.devices.front() != "auto")
        return fail(ErrorCode::usage,
                    fmt::format("--device {}: the station file names the devices", options.devices.front()),
                    "--station without --device, or with the id of one of its devices");
    BOLT_TRY(station_setup::add_devices_of(station, device::list_devices(true), equipment.devices));
    equipment.station = station;
    equipment.glove = station.glove_port;
    return {};
}

// CLI11 itself would accept "-1" and convert it to the largest unsigned number.
const CLI::Validator whole_number(
    [](const std::string& text) {
        std::uint64_t value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = problem == std::errc{} && end == text.data() + text.size();
        return whole ? std::string()
                     : "a whole number from 0 to 18446744073709551615 is expected, not " + text;
    },
    "WHOLE NUMBER");

void add_lesson_options(CLI::App& train, TrainArguments& options) {
    train.add_option("assembly", options.assembly, "Assembly: folder, file, or name in content/assemblies")
        ->capture_default_str();
    train.add_option("--variant", options.variant, "Variant of the assembly; default: the assembly's own");
    train.add_option("--tool", options.tool, "One of the assembly's tools; default: the first");
    train
        .add_option("--mode", options.mode,
                    "guided: a force guides the hand to the nut, and a step lasts until it is done; "
                    "practice: no guidance; assessment: a joint is judged as it is when the tool leaves it")
        ->check(CLI::IsMember({"guided", "practice", "assessment"}))
        ->capture_default_str();
    train.add_option("--task", options.task, "Tighten loose joints, or loosen tightened joints")
        ->check(CLI::IsMember({"tighten", "loosen"}))
        ->capture_default_str();
    train.add_option("--law", options.law, "Torque law; default: the assembly's own")
        ->check(CLI::IsMember({"published", "mechanistic"}));
}

void add_device_options(CLI::App& train, TrainArguments& options) {
    train.add_option(
        "--device", options.devices,
        "auto (a connected device, else the mouse), mouse, simulated-arm (the mouse moves the hand that "
        "holds a simulated arm), simulated (a simulated device: keys move the tool), or an id "
        "listed by boltwright devices; may be given twice, for a device that moves the tool and for a wheel");
    train
        .add_option("--hand", options.hand,
                    "The hand of the mouse: helped (it finds the nut by itself) or free (the mouse moves and "
                    "turns the wrench)")
        ->check(CLI::IsMember({"helped", "free"}))
        ->capture_default_str();
    train.add_option("--station", options.station_file,
                     "Station file: devices, glove and their settings; other options have precedence. "
                     "`boltwright station new` makes one");
    train.add_option("--rig", options.wheel_config_file,
                     "Configuration file of the wheel: its motor, its encoder");
    train.add_option("--glove", options.glove,
                     "Port of a CyberGlove calibrated for --trainee, auto, or none; default: the station "
                     "file's, else none");
    train
        .add_option("--hmd", options.hmd,
                    "Display in a headset (OpenXR). With optional, a headset is used as soon as there is "
                    "one, and until then the window")
        ->expected(0, 1)
        ->type_name("[optional]");
    train
        .add_option("--mirror", options.mirror,
                    "Picture in the window of a headset: left or right eye, both (side by side), or panel "
                    "(the left eye and the panel); key F9 changes it")
        ->check(CLI::IsMember(std::vector<std::string>(view::mirror_names.begin(), view::mirror_names.end())))
        ->capture_default_str();
    train.add_option(
        "--displays", options.displays,
        "Display file: shows the lesson on projection walls. `boltwright displays new` makes one");
    train.add_flag("--full-resolution", options.full_resolution,
                   "Keep the resolution of headset and window even if the GPU is too slow for it");
}

void add_window_options(CLI::App& train, TrainArguments& options) {
    train.add_option("--size", options.size, "WIDTHxHEIGHT of the window")->capture_default_str();
    train.add_flag("--full-screen", options.full_screen, "Use the full screen");
    train.add_option("--trainee", options.trainee,
                     "Name or code of the trainee. The code is recorded in the session and selects the "
                     "settings: keys, hand, captions, colours");
    train.add_option("--settings", options.settings,
                     "Settings file to use instead of the trainee's; created if it does not exist");
    train.add_option(
        "--language", options.language,
        "Code of a language in content/words, such as en; default: the trainee's or the desktop's");
    train.add_flag("--silent", options.silent, "No sound");
    train.add_option("--gpu", options.gpu, "Part of the name of the GPU to use");
    train.add_flag("--validate", options.validate,
                   "Run under the Vulkan validation layers; any message is an error");
}

void add_session_options(CLI::App& train, TrainArguments& options) {
    train.add_flag("--start", options.start, "Start the lesson immediately, without the menu");
    train.add_flag("--headless", options.headless,
                   "No window: a simulated trainee performs the lesson in virtual time");
    train
        .add_option("--operator", options.trainee_profile,
                    fmt::format("Simulated trainee: {}", fmt::join(trainees::profile_names(), ", ")))
        ->capture_default_str();
    train.add_option("--seed", options.seed, "Seed of the trainee and of the joints' scatter")
        ->check(whole_number)
        ->capture_default_str();
    train.add_option("--out", options.out, "Folder for session, summary and report")->capture_default_str();
    auto* obstacles = train.add_flag("--obstacles", options.obstacles,
                                     "Fail if the assembly has no contact model; if it has one, contacts "
                                     "with casing, bolts and nuts are simulated by default");
    train
        .add_flag("--no-obstacles", options.no_obstacles,
                  "Do not simulate contacts: the wrench passes through everything")
        ->excludes(obstacles);
    train.add_flag("--no-guide", options.no_guide, "No guiding force in a guided lesson");
    train.add_flag(
        "--view-help", options.view_help,
        "A simulated trainee requests views, like key V in the window; otherwise it only moves its head");
    train.add_flag("--no-pictures", options.no_pictures, "Do not draw pictures of the result");
    train.add_flag("--quiet", options.quiet, "Do not print the progress");
}

}  // namespace

void add_train_options(CLI::App& train, TrainArguments& options) {
    add_lesson_options(train, options);
    add_device_options(train, options);
    add_window_options(train, options);
    add_session_options(train, options);
}

void add_study_options(CLI::App& run, TrainArguments& options) {
    add_device_options(run, options);
    add_window_options(run, options);
}

Result<HeadsetUse> headset_use(TrainArguments& options) {
    if (!options.hmd) return HeadsetUse::none;
    const std::string value = std::exchange(options.hmd, "required").value();
    if (value == "optional") return HeadsetUse::optional;
    if (value.empty() || value == "required") return HeadsetUse::required;
    if (options.assembly != TrainArguments().assembly)
        return fail(ErrorCode::usage, fmt::format("--hmd: \"{}\"", value), "optional, or no value");
    options.assembly = value;
    return HeadsetUse::required;
}

Result<trainer::Equipment> equipment_of(const TrainArguments& options) {
    trainer::Equipment equipment;
    const bool station = !options.station_file.empty();
    const std::string first = options.devices.empty() ? "auto" : options.devices.front();
    if (options.devices.size() > 1 && std::any_of(options.devices.begin(), options.devices.end(), is_keyword))
        return fail(
            ErrorCode::usage,
            "--device: auto, mouse, simulated and simulated-arm cannot be combined with other devices",
            "only ids of devices");
    if (first == "auto" && !station)
        equipment = options.headless ? trainer::Equipment{} : trainer::default_equipment();
    else if (first == "simulated")
        equipment.hand = trainer::HandMode::keyboard;
    else if (first == "simulated-arm")
        equipment.hand = trainer::HandMode::simulated_arm;
    else if (first != "mouse" && first != "auto")
        equipment.devices = options.devices;
    if (station) BOLT_TRY(add_station_file(options, equipment));
    if (options.hand == "free") {
        const bool mouse = first == "mouse" || (first == "auto" && equipment.devices.empty());
        if (!mouse)
            return fail(ErrorCode::usage, "--hand free: a device moves the hand", "--device mouse with it");
        equipment.hand = trainer::HandMode::free;
    }
    equipment.wheel_config_file = options.wheel_config_file;
    if (options.glove == "auto") {
        const auto ports = serial_ports();
        if (!ports.empty()) equipment.glove = ports.front();
    } else if (!options.glove.empty()) {
        equipment.glove = options.glove == "none" ? std::string() : options.glove;
    }
    // Checked before a window opens.
    const auto chosen = station_setup::select_devices(device::list_devices(true), equipment.devices);
    if (!chosen) return fail(chosen.error());
    if (!equipment.glove.empty())
        if (Status access = check_port_access(equipment.glove); !access) return fail(access.error());
    return equipment;
}

Result<trainees::TrainOptions> train_options(const TrainArguments& options,
                                             const content::Assembly& assembly) {
    trainees::TrainOptions train;
    train.lesson.mode = lesson::mode_names.find(options.mode).value_or(lesson::Mode::guided);
    train.lesson.task = lesson::task_names.find(options.task).value_or(lesson::Task::tighten);
    train.lesson.law = joint::law_named(options.law).value_or(assembly.law);
    train.lesson.seed = options.seed;
    train.lesson.obstacles = options.no_obstacles ? session::ObstacleUse::none
                             : options.obstacles  ? session::ObstacleUse::required
                                                  : session::ObstacleUse::if_any;
    train.lesson.guiding_force = !options.no_guide;
    if (options.view_help) train.view_help = view::make_view_helper();
    Result<trainees::TraineeProfile> trainee = trainees::find_profile(options.trainee_profile);
    if (!trainee) return fail(trainee.error());
    train.trainee = *trainee;
    train.lesson.trainee_profile = train.trainee.name;
    train.lesson.trainee = options.trainee;
    return train;
}

}  // namespace bolt::cli
