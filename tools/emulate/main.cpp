// bolt-emulate: emulates a glove on a pseudo-terminal, a puck or a wheel in the kernel, or the service of an
// arm, for users without the hardware. Each device repeats one hand motion until a signal ends the program.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/program/program.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tools/emulate/arms/haply.hpp"
#include "tools/emulate/glove.hpp"
#include "tools/emulate/hid_device.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

namespace {

using namespace bolt;
using namespace bolt::emulate;

constexpr double motion_period = 4.0;      // s
constexpr double puck_amplitude = 0.5;     // fraction of the puck's travel
constexpr double wheel_amplitude = 0.5;    // rad
constexpr double grip_stiffness = 5.0;     // N·m/rad
constexpr double torque_threshold = 0.05;  // N·m, smallest change of the torque that is printed
constexpr double arm_amplitude = 0.02;     // m
constexpr double force_threshold = 0.2;    // N, smallest change of the force that is printed

volatile std::sig_atomic_t ended = 0;

// Plugs the device into the kernel and calls move(device, phase) every 10 ms until a signal ends the program.
template <class Device>
Status play(std::unique_ptr<Device> device, const std::function<Status(Device&, double)>& move) {
    const HidDescription description = device->description();
    BOLT_TRY_ASSIGN(auto plug, Uhid::plug_in(std::move(device)));
    Status status =
        print(fmt::format("{:04x}:{:04x}  {}\n", description.vendor, description.product, description.name));
    while (status && ended == 0) {
        plug.with([&](HidDevice& d) {
            status = move(dynamic_cast<Device&>(d), 2.0 * pi / motion_period * steady_seconds());
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return status;
}

// Pushes the puck in circles.
Status play_puck() {
    return play<EmulatedPuck>(
        std::make_unique<EmulatedPuck>(), [](EmulatedPuck& puck, double phase) -> Status {
            puck.deflection = {
                puck_amplitude * std::cos(phase), puck_amplitude * std::sin(phase), 0.0, 0.0, 0.0, 0.0};
            return {};
        });
}

// Turns the wheel to and fro, and prints the motor's torque when it changes.
Status play_wheel(bool board) {
    EmulatedWheelOptions options;
    options.board = board;
    double printed_torque = 0.0;
    return play<EmulatedWheel>(std::make_unique<EmulatedWheel>(options),
                               [&](EmulatedWheel& wheel, double phase) -> Status {
                                   wheel.hand_stiffness = grip_stiffness;
                                   wheel.hand = wheel_amplitude * std::sin(phase);
                                   if (std::abs(wheel.torque() - printed_torque) < torque_threshold)
                                       return {};
                                   printed_torque = wheel.torque();
                                   return print(fmt::format("torque {:.2f} N·m\n", printed_torque));
                               });
}

// Names of the postures in the order of hand::Posture, then a hand around a handle.
constexpr std::array<const char*, hand::posture_count + 1> postures{"flat", "fist", "spread", "across",
                                                                    "grip"};
constexpr double grip_closure = 0.9;  // argument of hand::closed_hand_angles

hand::PerSensor<std::uint8_t> posture_values(std::size_t posture) {
    return posture < hand::posture_count ? emulate::raw_values(static_cast<hand::Posture>(posture))
                                         : emulate::raw_values(hand::closed_hand_angles(grip_closure));
}

// Reads posture names from the standard input, one per line, and applies them to the glove.
struct PostureInput {
    std::string line;
    bool at_end = false;

    // Waits up to 50 ms for input. Fails on an unknown name.
    Status poll_input(emulate::SerialGlove& glove) {
        pollfd wait{STDIN_FILENO, POLLIN, 0};
        if (at_end || poll(&wait, 1, 50) <= 0) return {};
        std::array<char, 256> received{};
        const ssize_t n = read(STDIN_FILENO, received.data(), received.size());
        at_end = n <= 0;
        for (ssize_t i = 0; i < n; ++i) {
            const char c = received[static_cast<std::size_t>(i)];
            if (c != '\n') {
                line += c;
                continue;
            }
            const auto* name = std::find(postures.begin(), postures.end(), line);
            if (name == postures.end())
                return fail(ErrorCode::usage, fmt::format("standard input: unknown posture '{}'", line),
                            fmt::format("one of {}", fmt::join(postures, ", ")));
            glove.set_raw(posture_values(static_cast<std::size_t>(name - postures.begin())));
            line.clear();
        }
        return {};
    }
};

int play_glove(const emulate::EmulatedGloveOptions& options, double period, bool by_name,
               const std::string& link) {
    Result<emulate::SerialGlove> glove = emulate::SerialGlove::start(options, period);
    if (!glove) return print_error(glove.error());
    std::error_code failed;
    if (!link.empty()) {
        std::filesystem::create_symlink(glove->port(), link, failed);
        if (failed) {
            Error error;
            error.what = fmt::format("{}: cannot create the link: {}", link, failed.message());
            error.expected = "a new path that this user may write to";
            return print_error(error);
        }
    }
    Status status = print(fmt::format("{}\n", link.empty() ? glove->port().string() : link));
    PostureInput input{{}, !by_name};
    while (ended == 0 && status) {
        if (input.at_end) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        status = input.poll_input(*glove);
    }
    if (!link.empty()) std::filesystem::remove(link, failed);
    return status ? 0 : print_error(status.error());
}

// Moves the hand at the arm in circles, and prints the force on it when it changes.
Status play_haply(const EmulatedHaplyOptions& options) {
    BOLT_TRY_ASSIGN(const auto service, EmulatedHaply::start(options));
    Status status = print(fmt::format("127.0.0.1:{}\n", service->port()));
    Vec3 printed_force(0.0);
    while (status && ended == 0) {
        const double phase = 2.0 * pi / motion_period * steady_seconds();
        service->intend({arm_amplitude * std::cos(phase), 0.0, arm_amplitude * std::sin(phase)});
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        const Vec3 force = service->force();
        if (glm::distance(force, printed_force) < force_threshold) continue;
        printed_force = force;
        status = print(fmt::format("force {:.1f} {:.1f} {:.1f} N\n", force.x, force.y, force.z));
    }
    return status;
}

void add_haply_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<EmulatedHaplyOptions>();
    options->port = 10001;
    CLI::App* command = app.add_subcommand(
        "haply", "Haply's service with an Inverse3 and a VerseGrip; prints its address and the force");
    command->add_option("--port", options->port, "port of the states; 0: any that is free")
        ->capture_default_str();
    command->add_option("--grip", options->grip, "wireless, wired or none")
        ->transform(CLI::CheckedTransformer(std::map<std::string, HaplyGrip>{
            {"none", HaplyGrip::none}, {"wired", HaplyGrip::wired}, {"wireless", HaplyGrip::wireless}}))
        ->default_str("wireless");
    command->add_option("--version", options->version, "version of the service")->capture_default_str();
    command->add_flag_callback(
        "--uncalibrated", [options] { options->calibrated = false; }, "the arm is not calibrated");
    command->callback([options, &exit_code] {
        if (const Status played = play_haply(*options); !played) exit_code = print_error(played.error());
    });
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Emulates input devices until it is interrupted.", "bolt-emulate");
    app.require_subcommand(1);
    emulate::EmulatedGloveOptions options;
    bool left = false, by_name = false;
    double period = 4.0;
    std::string link;
    CLI::App* glove_command =
        app.add_subcommand("glove", "A CyberGlove on a pseudo-terminal; prints its path");
    glove_command->add_option("--sensors", options.sensors, "18 or 22")
        ->check(CLI::IsMember({18, 22}))
        ->capture_default_str();
    glove_command->add_flag("--left", left, "a left hand");
    glove_command
        ->add_option("--period", period, "period in s in which the hand opens and closes; 0: no motion")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    glove_command->add_flag(
        "--postures", by_name,
        "read postures from the standard input, one per line: flat, fist, spread, across or grip");
    glove_command->add_option("--drop", options.faults.dropped, "fraction of the bytes that are dropped")
        ->check(CLI::Range(0.0, 1.0));
    glove_command->add_option("--link", link, "create this symbolic link to the port");
    int exit_code = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { ended = 1; });
    const auto add_hid_device = [&](const char* name, const char* help, const auto& play_device) {
        app.add_subcommand(name, help)->callback([&exit_code, play_device] {
            const Status played = play_device();
            if (!played) exit_code = print_error(played.error());
        });
    };
    add_hid_device("puck", "A SpaceMouse, plugged into the kernel (needs root and the module uhid)",
                   play_puck);
    add_hid_device("board",
                   "An OpenFFBoard with a motor, plugged into the kernel (needs root and the module uhid)",
                   [] { return play_wheel(true); });
    add_hid_device("wheel",
                   "A generic force-feedback wheel, plugged into the kernel (needs root and the module uhid)",
                   [] { return play_wheel(false); });
    add_haply_command(app, exit_code);
    glove_command->callback([&] {
        options.hand = left ? hand::Side::left : hand::Side::right;
        exit_code = play_glove(options, by_name ? 0.0 : period, by_name, link);
    });
    return run_command_line(app, argc, argv, exit_code);
}
