#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"
#include "engine/platform/window.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/devices.hpp"
#include "game/cli/interruption.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "game/station/trial.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/servo/thread.hpp"

// boltwright doctor --device …: a station that is started, looked at for a while, and judged.

namespace bolt::cli {

struct StationOptions {
    std::string assembly = "zq350";
    std::vector<std::string> devices;
    std::string rig, glove, trainee, calibrations;
    double seconds = 5.0;

    [[nodiscard]] bool any() const { return !devices.empty() || !glove.empty(); }
};

// Says what happens and returns the exit code: 0 it is good enough to train with, 1 it ran and is not, or why
// it could not begin.
int try_station(const StationOptions& options);

// For whoever has not named one; empty: there is none to try.
std::string what_to_try();

}  // namespace bolt::cli

// How this machine keeps the servo's time: the tick of a lesson on its thread, for a while.

namespace bolt::cli {

// Text for a terminal: what the thread was given, histograms at 1 kHz and 4 kHz, and whether that is good
// enough.
Result<std::string> examine_servo(double seconds, const std::string& assembly);

namespace {

// A hand that puts the wrench on the first nut once a second, eight degrees off, so that it stands on top,
// and lifts it again: obstacles, god-object, guiding and output stage are all at work.
servo::Input working(const servo::Setup& setup, const servo::State& state) {
    const servo::NutGeometry& nut = setup.nuts.front();
    const double time = static_cast<double>(state.tick) * setup.dt;
    const Vec3 at = servo::nut_centre(nut, 0.0) + nut.axis * (0.014 + 0.012 * std::cos(2.0 * pi * time));
    // Away from the casing: out over the flange's edge.
    const double handle = setup.wrench.head_angle + to_radians(8.0) + (nut.seat.z > 0.0 ? 0.5 : 1.5) * pi;
    const double nearest =
        std::round(handle / (pi / 3.0)) * (pi / 3.0) + setup.wrench.head_angle + to_radians(8.0);
    const Vec3 x = std::cos(-nearest) * nut.e1 + std::sin(-nearest) * nut.e2;
    const Quat q = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
    servo::Input input;
    input.device = servo::sample_of({at, q});
    input.grip = servo::Grip::wrench;
    input.enabled = true;
    input.guide = 0;
    return input;
}

std::string describe(const servo::ThreadPrivileges& granted) {
    std::string text;
    if (granted.priority > 0) text += fmt::format("  real-time priority {} (SCHED_FIFO)\n", granted.priority);
    if (granted.memory_locked) text += "  memory is locked\n";
    for (const std::string& refused : granted.refused) text += "  " + refused + "\n";
    return text;
}

}  // namespace

Result<std::string> examine_servo(double seconds, const std::string& assembly) {
    const content::Loaded loaded = content::load_assembly(assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    std::string text;
    std::optional<servo::ToolContact> touch;  // made once: it takes seconds
    for (const double rate : {1000.0, 4000.0}) {
        const servo::Setup setup =
            session::make_setup(loaded.assembly, loaded.assembly.law, force::OutputLimits{}, 0, 1.0 / rate);
        servo::State state = servo::initial_state(setup);
        if (!touch) {
            BOLT_TRY_ASSIGN(auto made, session::load_tool_contact(loaded.assembly, setup));
            touch = std::move(made);
        }
        if (touch) servo::set_coupling(setup, *touch);
        state.tool_contact = std::move(touch);
        servo::tick(setup, state, working(setup, state));  // the first one proves everything anew
        servo::ThreadOptions options;
        options.rate = rate;
        BOLT_TRY_ASSIGN(auto thread, servo::Thread::start(options, [&](const servo::Deadline&) {
                            servo::tick(setup, state, working(setup, state));
                            return true;
                        }));
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        thread.stop();
        if (text.empty()) text = describe(thread.privileges());
        touch = std::move(state.tool_contact);
        const servo::HostAssessment assessment = servo::assess_host(thread.timing(), rate);
        text += fmt::format("  at {:.0f} ticks a second this machine is {}\n", rate,
                            assessment.adequate ? "good enough" : "NOT good enough");
        for (const std::string& reason : assessment.reasons) text += "    " + reason + "\n";
        text += servo::describe(thread.timing());
    }
    return text;
}

namespace {

std::string begins(const StationOptions& options, const content::Assembly& assembly,
                   const station_setup::Planned& planned, const station::Station& station) {
    const std::string& joint = assembly.joints.front().design.id;
    std::string text = "Devices:\n" + station_setup::introduce(station.layout(), planned.choice);
    text += fmt::format("The wrench sits on nut {} of {}, which is tight{}.\n", joint, assembly.name,
                        planned.obstacles ? "" : "; nothing can be bumped into");
    if (!options.glove.empty() && planned.worn)
        text += "It is in the hand as soon as the gloved hand closes.\n";
    return text + fmt::format("For {:g} s from now on:\n", options.seconds);
}

}  // namespace

int try_station(const StationOptions& options) {
    const content::Loaded loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return print_error(loaded.errors);
    device::VirtualPuck still({}, device::steady_timer());  // where there is no device that moves the tool
    station_setup::Wanted wanted;
    wanted.devices = options.devices;
    wanted.rig = options.rig;
    wanted.otherwise = still.open();
    wanted.glove = options.glove;
    wanted.trainee = options.trainee;
    wanted.calibrations = options.calibrations;
    wanted.tight = true;

    Result<station_setup::Planned> planned = station_setup::make_plan(loaded.assembly, wanted);
    if (!planned) return print_error(planned.error());
    if (!planned->choice.mover) planned->plan.mover_buttons = {0, 0, 0, 0};
    Result<station::Station> station = station::Station::start(std::move(planned->plan));
    if (!station) return print_error(station.error());
    if (Status said = print(begins(options, loaded.assembly, *planned, *station)); !said)
        return print_error(said.error());

    catch_interruption();
    Status said;
    const station_setup::Trial trial = station_setup::try_station(
        *station, *planned, options.seconds, [&] { return interrupted() || !said; },
        [&](double time, const std::string& words) {
            if (said) said = print(fmt::format("  {:5.1f} s  {}\n", time, words));
        });
    const std::vector<std::string> against = station_setup::against(trial);
    if (said)
        said = print(station_setup::report(trial) +
                     (against.empty() ? "This station is good enough\n"
                                      : fmt::format("This station is not good enough, because\n  {}\n",
                                                    fmt::join(against, "\n  "))));
    if (!said) return print_error(said.error());
    return against.empty() ? 0 : static_cast<int>(ErrorCode::failed);
}

std::string what_to_try() {
    const std::vector<std::string> ids =
        station_setup::ids_of(station_setup::choose_any(device::list_devices()));
    std::string text;
    if (!ids.empty())
        text = fmt::format("  boltwright doctor --device {} tries {}\n", fmt::join(ids, " --device "),
                           ids.size() == 1 ? "it" : "them");
    if (const auto ports = hand::serial_ports(); !ports.empty())
        text += fmt::format("  boltwright doctor --glove {} --trainee NAME tries a glove there\n",
                            ports.front().string());
    return text;
}

// boltwright doctor: what this machine has, what of it would be used, and whether it keeps the servo's time.
// With devices or a glove named: whether they and this machine are a station to train with.

namespace {

// What a window would show, and on what; or why there would be none.
Result<std::string> examine_windows() {
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    platform::WindowOptions options;
    options.hidden = true;
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(desktop, options));
    BOLT_TRY_ASSIGN(const auto extensions, desktop.vulkan_extensions());
    BOLT_TRY_ASSIGN(const auto instance, gpu::Instance::create({false, extensions}));
    BOLT_TRY_ASSIGN(const auto surface, window.make_surface(instance));
    BOLT_TRY_ASSIGN(const auto found, gpu::survey_devices(instance, {"", surface.get()}));
    if (found.choice.index < 0) return fail(ErrorCode::no_device, "no GPU can show on this display");
    const auto index = static_cast<std::size_t>(found.choice.index);
    gpu::SurfaceSupport offer;
    const VkResult asked = gpu::query_surface(found.physical[index], surface.get(), offer);
    BOLT_TRY(gpu::check(asked, "asking what a window can show"));
    BOLT_TRY_ASSIGN(const auto plan, gpu::plan_swapchain(offer, {{1, 1}}));
    return fmt::format("  drawn by {}\n  {}\n  {:.0f} pictures a second{}, scale {:.2f}\n",
                       found.candidates[index].name, fmt::join(plan.reasons, "\n  "),
                       1.0 / platform::period_of(window.refresh()),
                       window.refresh() > 0.0 ? "" : " (the display does not tell)",
                       static_cast<double>(window.content_scale()));
}

Status examine() {
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
                    "mesa-vulkan-drivers renders without a GPU");
    return {};
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
    struct Options {
        StationOptions station;
        std::optional<double> seconds;
    };
    auto options = std::make_shared<Options>();
    CLI::App* doctor = app.add_subcommand(
        "doctor",
        "Say what this machine has for drawing, what would be used, and how it keeps the servo's time. With "
        "a "
        "device or a glove named: run a station with them, say how it goes and whether it is good enough "
        "(exit code 0) or not (1); needs no display and no GPU");
    StationOptions& station = options->station;
    doctor->add_option("assembly", station.assembly, "What is worked on meanwhile: folder, file or name")
        ->capture_default_str();
    doctor
        ->add_option(
            "--device", station.devices,
            "Try this one, by its id as `boltwright devices` has it; given twice: one that moves the "
            "tool and one that turns the wrench. No force goes out unless its button is held")
        ->expected(1)
        ->take_all();
    auto* device = doctor->get_option("--device");
    doctor->add_option("--rig", station.rig, "What this rig file says of the wheel: its motor, its encoder")
        ->needs(device);
    auto* glove = doctor->add_option("--glove", station.glove, "Try the glove on this serial port");
    auto* trainee =
        doctor->add_option("--trainee", station.trainee,
                           "Whose hand is in it, by the calibration that `boltwright glove` keeps");
    trainee->needs(glove);
    doctor->add_option("--folder", station.calibrations, "Where that is kept; else the user's data folder")
        ->needs(trainee);
    doctor
        ->add_option("--seconds", options->seconds,
                     "how long the station is tried (5), or the servo timed at each rate (2; 0: not at all)")
        ->check(CLI::Range(0.0, 3600.0));
    doctor->callback([&exit_code, options] {
        if (options->station.any()) {
            options->station.seconds = options->seconds.value_or(options->station.seconds);
            exit_code = try_station(options->station);
            return;
        }
        const Status drawing = examine();
        Status servo = print(devices_line() + what_to_try());
        const double seconds = options->seconds.value_or(2.0);
        if (servo && seconds > 0.0) {
            const Result<std::string> text = examine_servo(seconds, options->station.assembly);
            servo =
                print("Servo:\n" + (text ? *text : fmt::format("  not timed: {}\n", text.error().message())));
        }
        exit_code = !drawing ? print_error(drawing.error()) : !servo ? print_error(servo.error()) : 0;
    });
}

}  // namespace bolt::cli
