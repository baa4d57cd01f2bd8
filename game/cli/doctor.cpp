// boltwright doctor: what this machine has, what of it would be used, and whether it keeps the servo's time.
// With devices or a glove named: whether they and this machine are a station to train with.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "engine/base/console.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain_choice.hpp"
#include "engine/platform/pace.hpp"
#include "engine/platform/window.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/devices.hpp"
#include "game/cli/servo_host.hpp"
#include "game/cli/try_station.hpp"

namespace bolt::cli {

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
