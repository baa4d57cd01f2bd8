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
#include <thread>

#include "engine/base/math.hpp"
#include "engine/base/program.hpp"
#include "engine/base/result.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tools/emulate/glove.hpp"
#include "tools/emulate/hid_device.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

// Emulated HID devices in the kernel, with a hand at them that does the same over and over, for those who
// have none. They end when `ended` says so.

namespace bolt::emulate {

// Pushed in circles.
Status play_puck(const std::function<bool()>& ended);

// Rocked to and fro; tells the torque of its motor whenever there is another one.
Status play_wheel(bool board, const std::function<bool()>& ended);

namespace {

constexpr double period = 4.0;  // s of the hand's motion
constexpr double pushed = 0.5;  // share of a puck's travel
constexpr double rocked = 0.5;  // rad of a wheel
constexpr double grip = 5.0;    // N·m/rad
constexpr double felt = 0.05;   // N·m: so much less or more is told

template <class Device>
Status play(std::unique_ptr<Device> device, const std::function<bool()>& ended,
            const std::function<Status(Device&, double)>& move) {
    const HidDescription design = device->design();
    BOLT_TRY_ASSIGN(auto plug, Uhid::plug_in(std::move(device)));
    Status said = print(fmt::format("{:04x}:{:04x}  {}\n", design.vendor, design.product, design.name));
    while (said && !ended()) {
        plug.with([&](HidDevice& d) {
            said = move(dynamic_cast<Device&>(d), 2.0 * pi / period * device::steady_seconds());
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return said;
}

}  // namespace

Status play_puck(const std::function<bool()>& ended) {
    return play<Puck>(std::make_unique<Puck>(), ended, [](Puck& puck, double phase) -> Status {
        puck.share = {pushed * std::cos(phase), pushed * std::sin(phase), 0.0, 0.0, 0.0, 0.0};
        return {};
    });
}

Status play_wheel(bool board, const std::function<bool()>& ended) {
    WheelOptions design;
    design.board = board;
    double told = 0.0;
    return play<Wheel>(std::make_unique<Wheel>(design), ended, [&](Wheel& wheel, double phase) -> Status {
        wheel.hand_stiffness = grip;
        wheel.hand = rocked * std::sin(phase);
        if (std::abs(wheel.torque() - told) < felt) return {};
        told = wheel.torque();
        return print(fmt::format("torque {:.2f} N·m\n", told));
    });
}

}  // namespace bolt::emulate

// bolt-emulate: devices that are not there, for those who have none at hand.

using namespace bolt;

namespace {

volatile std::sig_atomic_t ended = 0;

// As hand::Posture has them, and a hand around a handle.
constexpr std::array<const char*, hand::posture_count + 1> postures{"flat", "fist", "spread", "across",
                                                                    "grip"};
constexpr double gripping = 0.9;  // hand::closing's share

hand::PerSensor<std::uint8_t> raw_in(std::size_t posture) {
    return posture < hand::posture_count ? emulate::raw_values(static_cast<hand::Posture>(posture))
                                         : emulate::raw_values(hand::closed_hand_angles(gripping));
}

// Takes the postures that are named on the standard input, a line each, until it ends.
struct Asked {
    std::string line;
    bool over = false;

    Status advance(emulate::SerialGlove& glove) {
        pollfd wait{STDIN_FILENO, POLLIN, 0};
        if (over || poll(&wait, 1, 50) <= 0) return {};
        std::array<char, 256> heard{};
        const ssize_t n = read(STDIN_FILENO, heard.data(), heard.size());
        over = n <= 0;
        for (ssize_t i = 0; i < n; ++i) {
            const char c = heard[static_cast<std::size_t>(i)];
            if (c != '\n') {
                line += c;
                continue;
            }
            const auto* name = std::find(postures.begin(), postures.end(), line);
            if (name == postures.end())
                return fail(ErrorCode::usage, fmt::format("no posture '{}'", line),
                            fmt::format("one of {}", fmt::join(postures, ", ")));
            glove.show(raw_in(static_cast<std::size_t>(name - postures.begin())));
            line.clear();
        }
        return {};
    }
};

int play(const emulate::GloveOptions& design, double period, bool by_name, const std::string& link) {
    Result<emulate::SerialGlove> line = emulate::SerialGlove::start(design, period);
    if (!line) return print_error(line.error());
    std::error_code failed;
    if (!link.empty()) {
        std::filesystem::create_symlink(line->port(), link, failed);
        if (failed) {
            Error error;
            error.what = fmt::format("no link {}: {}", link, failed.message());
            return print_error(error);
        }
    }
    Status said = print(fmt::format("{}\n", link.empty() ? line->port().string() : link));
    Asked asked{{}, !by_name};
    while (ended == 0 && said) {
        if (asked.over) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        said = asked.advance(*line);
    }
    if (!link.empty()) std::filesystem::remove(link, failed);
    return said ? 0 : print_error(said.error());
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Plays devices that are not there, until it is ended.", "bolt-emulate");
    app.require_subcommand(1);
    emulate::GloveOptions design;
    bool left = false, by_name = false;
    double period = 4.0;
    std::string link;
    CLI::App* worn = app.add_subcommand("glove", "A CyberGlove on a serial port whose name it prints");
    worn->add_option("--sensors", design.sensors, "18 or 22")
        ->check(CLI::IsMember({18, 22}))
        ->capture_default_str();
    worn->add_flag("--left", left, "a left hand");
    worn->add_option("--period", period, "s in which the hand opens and closes once; 0: it is still")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    worn->add_flag(
        "--asked", by_name,
        "the hand takes the postures named on the standard input, a line each: flat, fist, spread, "
        "across, grip");
    worn->add_option("--lost", design.faults.dropped, "share of the bytes that get lost")
        ->check(CLI::Range(0.0, 1.0));
    worn->add_option("--link", link, "a name for the port, as a link to it");
    int exit_code = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { ended = 1; });
    const auto plugged = [&](const char* name, const char* help, const auto& play_it) {
        app.add_subcommand(name, help)->callback([&exit_code, play_it] {
            const Status played = play_it([] { return ended != 0; });
            if (!played) exit_code = print_error(played.error());
        });
    };
    plugged("puck", "A SpaceMouse, plugged into the kernel (root, module uhid)", emulate::play_puck);
    plugged("board", "An OpenFFBoard with a motor, plugged into the kernel",
            [](const auto& over) { return emulate::play_wheel(true, over); });
    plugged("wheel", "Another wheel with force feedback, plugged into the kernel",
            [](const auto& over) { return emulate::play_wheel(false, over); });
    worn->callback([&] {
        design.hand = left ? hand::Side::left : hand::Side::right;
        exit_code = play(design, by_name ? 0.0 : period, by_name, link);
    });
    return run_command_line(app, argc, argv, exit_code);
}
