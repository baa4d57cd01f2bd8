// What OpenFFBoard (1209:ffb0) is asked beside USB's force feedback, and how it answers: a report of the
// maker's own. Bytes only.
//
// OpenFFBoard wiki, "Commands" (HID); of the axis class the numbers up to 9 are the same in all versions of
// the firmware that were looked at, those behind are not.
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
    power = 0,     // 0 … 32767 of what the motor driver can
    degrees = 1,   // that the joystick's axis spans from end to end
    position = 9,  // of the encoder, counts
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

std::array<std::uint8_t, report_bytes> bytes_of(const Message& message);

// None: it is no such report, or a short one.
std::optional<Message> message_in(std::span<const std::uint8_t> report);

// An answer of the first axis to a question: its value. None: it is none.
std::optional<std::int64_t> answer_to(Command question, const Message& message);

}  // namespace bolt::device::board
