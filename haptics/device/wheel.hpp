// Wheels with USB force feedback as device drivers: one rotating axis (Sensing::angle) that renders torque;
// and the vendor report of OpenFFBoard.
//
// Source: OpenFFBoard wiki, "Commands" (HID). Command numbers of the axis class up to 9 agree in all firmware
// versions that we compared; higher numbers differ.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/device/report_descriptor.hpp"

// Encodes and decodes the vendor report of OpenFFBoard (1209:ffb0), which reads settings that USB force
// feedback lacks. No I/O.
namespace bolt::device::open_ffboard {

constexpr std::uint8_t report_id = 0xa1;
constexpr std::size_t report_bytes = 25;  // with the id
constexpr std::uint16_t axis_class = 0x0a01;

enum class MessageType : std::uint8_t {
    write = 0,
    request = 1,
    info = 2,
    acknowledged = 10,
    not_found = 13,
    error = 15
};

enum class Command : std::uint32_t {
    power = 0,     // full-scale motor torque, 0 … 32767
    degrees = 1,   // range of the joystick axis
    position = 9,  // encoder position in counts
};

constexpr double full_power = 32767.0;

struct WheelMessage {
    MessageType type = MessageType::request;
    std::uint16_t class_id = axis_class;
    std::uint8_t instance = 0;
    std::uint32_t command = 0;
    std::int64_t data = 0;
    std::uint64_t address = 0;
    friend bool operator==(const WheelMessage&, const WheelMessage&) = default;
};

std::array<std::uint8_t, report_bytes> encode_message(const WheelMessage& message);

// Returns nullopt for another report or a short one.
std::optional<WheelMessage> decode_message(std::span<const std::uint8_t> report);

// The value that axis 0 returns for `command`; nullopt if the message is not that reply.
std::optional<std::int64_t> reply_value(Command command, const WheelMessage& message);

}  // namespace bolt::device::open_ffboard

namespace bolt::device {

// The fields of a wheel's input report.
struct WheelAxis {
    ReportField axis;                  // usage Steering, X or Wheel, the first that the device has
    std::vector<ReportField> buttons;  // sorted by button number
    bool numbered = false;
};

struct WheelState {
    double deflection = 0.0;    // −1 at the left stop, 1 at the right stop
    std::uint32_t buttons = 0;  // bit i: button i is pressed
};

Result<WheelAxis> wheel_axis(const ReportDescriptor& descriptor);

// Decodes an input report (numbered reports begin with their id). Returns false if it has no angle.
bool decode_report(const WheelAxis& layout, std::span<const std::uint8_t> report, WheelState& state);

// Opens any wheel. Range and motor torque come from `config`. A wheel at rest sends nothing; silence counts
// as rest for 0.25 s.
Result<std::unique_ptr<DeviceDriver>> make_wheel(std::unique_ptr<HidTransport> transport,
                                                 const ReportDescriptor& descriptor, std::string name,
                                                 std::string id, const WheelConfig& config = {},
                                                 SecondsClock clock = steady_seconds);

// Opens an OpenFFBoard: range and power are read at opening, the encoder continuously, so that silence at
// rest is detected as a loss. The angle is unlimited if `config` gives counts per turn.
Result<std::unique_ptr<DeviceDriver>> make_open_ffboard(std::unique_ptr<HidTransport> transport,
                                                        const ReportDescriptor& descriptor, std::string name,
                                                        std::string id, const WheelConfig& config = {},
                                                        SecondsClock clock = steady_seconds);

}  // namespace bolt::device
