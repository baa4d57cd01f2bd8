// boltwright doctor: checks this machine for drawing and for the servo's timing, and lists what it would use.
// With named devices or a glove it runs a trial of that station instead and assesses it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/station/station_file.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/base/serial_port.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"
#include "engine/platform/window.hpp"
#include "game/cli/commands.hpp"
#include "game/computer/computer.hpp"
#include "game/station/station_check.hpp"
#include "game/station/trial.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::cli {

namespace {

// Times the servo of the assembly's lesson at 1 kHz and 4 kHz for `seconds` each. Returns the thread's
// privileges, the histograms and the assessments as text.
Result<std::string> examine_servo(double seconds, const std::string& assembly) {
    BOLT_TRY_ASSIGN(const auto timings, computer::time_servo(assembly, {1000.0, 4000.0}, seconds));
    std::string text = station_setup::describe(timings.front().privileges);
    for (const computer::ServoTiming& timed : timings) {
        text += fmt::format("  at {:.0f} ticks a second this machine is {}\n", timed.rate,
                            timed.assessment.adequate ? "good enough" : "NOT good enough");
        for (const std::string& reason : timed.assessment.reasons) text += "    " + reason + "\n";
        text += servo::describe(timed.timing);
    }
    return text;
}

// Prints the findings on this computer with the texts of the menu.
Status summarize() {
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    computer::FactsRequest request;
    request.gpu = computer::find_gpu();
    request.sessions = data / "sessions";
    const words::LoadedWords english = words::load_words(words::words_folder(), "en");
    if (!english.ok()) return fail(english.errors.front());
    return print("In short:\n" +
                 computer::describe(english.words, computer::findings(computer::gather_facts(request))));
}

std::string trial_header(const TrialOptions& options, const content::Assembly& assembly,
                         const station_setup::PlannedStation& planned, const station::Station& station) {
    const std::string& joint = assembly.joints.front().design.id;
    std::string text = "Devices:\n" + station_setup::describe_station(station.layout(), planned.devices);
    text += fmt::format("The wrench sits on nut {} of {}, which is tight{}.\n", joint, assembly.name,
                        planned.obstacles ? "" : "; the assembly has no contact models");
    if (!planned.glove.empty() && planned.calibration) text += "The gloved hand takes it by closing.\n";
    return text + fmt::format("For {:g} s from now on:\n", options.seconds);
}

// The settings of the station file that its devices cannot follow.
std::string station_remarks(const content::StationFile& file, const station_setup::PlannedStation& planned,
                            station::Station& station) {
    station_setup::StationFacts facts;
    if (planned.devices.mover && station.mover_status() != nullptr)
        facts.arm = *station.mover_status()->description;
    if (station.wheel_status() != nullptr) facts.wheel = *station.wheel_status()->description;
    content::StationFile devices = file;
    if (devices.arm) devices.arm->tool.clear();  // the trial does not depend on it
    const std::string text = station_setup::describe(station_setup::compare(devices, facts));
    return text.empty() ? text : "Station file:\n" + text;
}

// The person who wears the glove; empty texts if nobody is named.
Result<content::Person> wearer_of_trial(const TrialOptions& options) {
    if (options.trainee.empty()) return content::Person{};
    std::filesystem::path gloves = options.calibrations;
    if (gloves.empty()) {
        BOLT_TRY_ASSIGN(gloves, station_setup::calibrations_folder());
    }
    return person_argument(options.trainee, gloves, NewPerson::unchanged);
}

// The request that the options describe. An option has precedence over the station file.
Result<station_setup::StationRequest> request_of(const TrialOptions& options, const content::Person& wearer) {
    station_setup::StationRequest request;
    request.devices = options.devices;
    request.wheel_config_file = options.wheel_config_file;
    request.glove = options.glove;
    request.trainee = wearer.code.empty() ? wearer.name : wearer.code;
    request.calibrations = options.calibrations;
    request.tightened = true;
    request.arm_dialog = terminal_dialog(options.yes);
    if (options.station_file.empty()) return request;
    BOLT_TRY_ASSIGN(const auto station, content::load_station(options.station_file));
    BOLT_TRY(station_setup::add_devices_of(station, device::list_devices(true), request.devices));
    if (request.glove.empty()) request.glove = station.glove_port;
    request.station = station;
    return request;
}

}  // namespace

int try_station(const TrialOptions& options) {
    const content::LoadedAssembly loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return print_error(loaded.errors);
    const Result<content::Person> wearer = wearer_of_trial(options);
    if (!wearer) return print_error(wearer.error());
    Result<station_setup::StationRequest> request = request_of(options, *wearer);
    if (!request) return print_error(request.error());
    const Status examined = check_devices(*request, std::min(options.seconds, 1.0), options.yes);
    if (!examined) return print_error(examined.error());
    device::VirtualPuck still({}, device::steady_timer());  // used if no device moves the tool
    request->fallback_mover = still.factory();

    Result<station_setup::PlannedStation> planned = station_setup::plan_station(loaded.assembly, *request);
    if (!planned) return print_error(planned.error());
    if (planned->calibration && !wearer->code.empty())
        planned->calibration->trainee = content::name_and_code(*wearer);  // for the report
    if (!planned->devices.mover) planned->options.mover_buttons = {0, 0, 0, 0};
    Result<station::Station> station = station::Station::start(std::move(planned->options));
    if (!station) return print_error(station.error());
    if (Status printed = print(station_remarks(request->station, *planned, *station) +
                               trial_header(options, loaded.assembly, *planned, *station));
        !printed)
        return print_error(printed.error());

    catch_interruption();
    Status printed;
    const station_setup::StationTrial trial = station_setup::run_trial(
        *station, *planned, options.seconds, [&] { return interrupted() || !printed; },
        [&](double time, const std::string& message) {
            if (printed) printed = print(fmt::format("  {:5.1f} s  {}\n", time, message));
        });
    const std::vector<std::string> reasons = station_setup::unfit_reasons(trial);
    if (printed)
        printed = print(station_setup::trial_report(trial) +
                        (reasons.empty() ? "This station is good enough\n"
                                         : fmt::format("This station is not good enough, because\n  {}\n",
                                                       fmt::join(reasons, "\n  "))));
    if (!printed) return print_error(printed.error());
    return reasons.empty() ? 0 : static_cast<int>(ErrorCode::failed);
}

namespace {

// Commands that would run a trial with the connected devices; empty if there are none.
std::string suggested_trials() {
    const std::vector<std::string> ids =
        station_setup::ids_of(station_setup::select_any_devices(device::list_devices()));
    std::string text;
    if (!ids.empty())
        text = fmt::format("  boltwright doctor --device {} tries {}\n", fmt::join(ids, " --device "),
                           ids.size() == 1 ? "it" : "them");
    if (const auto ports = serial_ports(); !ports.empty())
        text += fmt::format("  boltwright doctor --glove {} --trainee NAME tries a glove there\n",
                            ports.front().string());
    return text;
}

// Describes the GPU, format and refresh rate of a window; fails if no window can be opened.
Result<std::string> examine_windows() {
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    platform::WindowOptions options;
    options.hidden = true;
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(desktop, options));
    BOLT_TRY_ASSIGN(const auto extensions, desktop.vulkan_extensions());
    BOLT_TRY_ASSIGN(const auto instance, gpu::Instance::create({false, extensions}));
    BOLT_TRY_ASSIGN(const auto surface, window.make_surface(instance));
    BOLT_TRY_ASSIGN(const auto found, gpu::survey_devices(instance, {"", surface.get()}));
    if (found.choice.index < 0)
        return fail(ErrorCode::no_device, "no GPU can draw to this display",
                    "a GPU that the display's windows can use");
    const auto index = static_cast<std::size_t>(found.choice.index);
    gpu::SurfaceSupport offer;
    const VkResult queried = gpu::query_surface(found.physical[index], surface.get(), offer);
    BOLT_TRY(gpu::check(queried, "querying the surface of a window"));
    BOLT_TRY_ASSIGN(const auto swapchain, gpu::plan_swapchain(offer, {{1, 1}}));
    return fmt::format("  drawn by {}\n  {}\n  {:.0f} pictures a second{}, scale {:.2f}\n",
                       found.candidates[index].name, fmt::join(swapchain.reasons, "\n  "),
                       1.0 / platform::period_of(window.refresh_rate()),
                       window.refresh_rate() > 0.0 ? "" : " (assumed; the display does not report it)",
                       static_cast<double>(window.content_scale()));
}

Status examine_drawing() {
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create({}));
    BOLT_TRY_ASSIGN(const auto found, gpu::survey_devices(instance, {}));
    std::string text = "Vulkan devices:\n";
    for (const std::string& reason : found.choice.reasons) text += fmt::format("  {}\n", reason);
    gpu::InstanceOptions validated;
    validated.validation = true;
    text +=
        fmt::format("Validation layers: {}\n",
                    gpu::Instance::create(validated) ? "installed" : "not installed (only tests need them)");
    const Result<std::string> windows = examine_windows();
    text += "Windows:\n" + (windows ? *windows : fmt::format("  none: {}\n", windows.error().message()));
    BOLT_TRY(print(text));
    if (found.choice.index < 0)
        return fail(ErrorCode::no_device, "no Vulkan device can be used",
                    "a GPU with a Vulkan driver, or mesa-vulkan-drivers, which renders without a GPU");
    return {};
}

struct DoctorOptions {
    TrialOptions station;
    std::optional<double> seconds;
};

// Returns the exit code.
int run_doctor(DoctorOptions& options) {
    TrialOptions& station = options.station;
    if (station.station_file.empty()) {
        if (!station.wheel_config_file.empty() && station.devices.empty())
            throw CLI::RequiresError("--rig", "--device or --station");
        if (!station.trainee.empty() && station.glove.empty())
            throw CLI::RequiresError("--trainee", "--glove or --station");
        if (station.yes && station.devices.empty())
            throw CLI::RequiresError("--yes", "--device or --station");
    }
    if (station.any()) {
        station.seconds = options.seconds.value_or(station.seconds);
        return try_station(station);
    }
    const Status drawing = examine_drawing();
    Status printed = print(devices_line() + suggested_trials());
    if (printed) printed = summarize();
    const double seconds = options.seconds.value_or(2.0);
    if (printed && seconds > 0.0) {
        const Result<std::string> text = examine_servo(seconds, station.assembly);
        printed =
            print("Servo:\n" + (text ? *text : fmt::format("  not timed: {}\n", text.error().message())));
    }
    return !drawing ? print_error(drawing.error()) : !printed ? print_error(printed.error()) : 0;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DoctorOptions>();
    CLI::App* doctor = app.add_subcommand(
        "doctor",
        "Check this machine: GPUs, windows and the timing of the servo. With --device, --glove or --station: "
        "examine each device (model, limits, rate, delays, the stiffness that it renders stably here), run a "
        "station with them and assess whether it is good enough for training (exit code 0) or not (1); needs "
        "no display and no GPU");
    TrialOptions& station = options->station;
    doctor
        ->add_option("assembly", station.assembly, "Assembly that the servo simulates: folder, file or name")
        ->capture_default_str();
    doctor
        ->add_option("--device", station.devices,
                     "Id of a device to try, as listed by `boltwright devices`; may be given twice, for one "
                     "that moves the tool and one that turns the wrench. A device renders no force unless "
                     "its button is held")
        ->expected(1)
        ->take_all();
    doctor->add_option(
        "--station", station.station_file,
        "Station file to try: devices, glove and their settings; other options have precedence");
    doctor->add_option("--rig", station.wheel_config_file,
                       "Configuration file of the wheel: its motor, its encoder");
    doctor->add_option("--glove", station.glove, "Serial port of a glove to try");
    auto* trainee = doctor->add_option("--trainee", station.trainee,
                                       "Wearer of the glove, with a calibration made by `boltwright glove`");
    doctor
        ->add_option("--folder", station.calibrations,
                     "Folder of calibrations; default: the user's data folder")
        ->needs(trainee);
    doctor->add_flag("--yes", station.yes,
                     "Permit an arm to move by itself and to push the hand; without this option the terminal "
                     "asks. Keep the room around it free, and hold its handle and its button");
    doctor
        ->add_option("--seconds", options->seconds,
                     "Duration of the trial (5), or of the timing at each rate of the servo (2; 0: none)")
        ->check(CLI::Range(0.0, 3600.0));
    doctor->callback([&exit_code, options] { exit_code = run_doctor(*options); });
}

}  // namespace bolt::cli
