// Encodes and decodes the vendor report of OpenFFBoard (1209:ffb0), which reads settings that USB force
// feedback lacks. No I/O.
//
// Source: OpenFFBoard wiki, "Commands" (HID). Command numbers of the axis class up to 9 agree in all firmware
// versions that we compared; higher numbers differ.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace bolt::device::board {

constexpr std::uint8_t report_id = 0xa1;
constexpr std::size_t report_bytes = 25;  // with the id
constexpr std::uint16_t axis_class = 0x0a01;

enum class Type : std::uint8_t {
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

struct Message {
    Type type = Type::request;
    std::uint16_t of_class = axis_class;
    std::uint8_t instance = 0;
    std::uint32_t command = 0;
    std::int64_t data = 0;
    std::uint64_t address = 0;
    friend bool operator==(const Message&, const Message&) = default;
};

std::array<std::uint8_t, report_bytes> encode_message(const Message& message);

// Returns nullopt for another report or a short one.
std::optional<Message> decode_message(std::span<const std::uint8_t> report);

// The value that axis 0 returns for `question`; nullopt if the message is not that reply.
std::optional<std::int64_t> reply_value(Command question, const Message& message);

}  // namespace bolt::device::board
