#include "haptics/device/board_request.hpp"

namespace bolt::device::board {

namespace {

void put(std::span<std::uint8_t> at, std::uint64_t value) {
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t take(std::span<const std::uint8_t> at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < at.size(); ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
    return value;
}

}  // namespace

std::array<std::uint8_t, report_bytes> encode_message(const Message& message) {
    std::array<std::uint8_t, report_bytes> bytes{};
    const std::span<std::uint8_t> all(bytes);
    bytes[0] = report_id;
    bytes[1] = static_cast<std::uint8_t>(message.type);
    put(all.subspan(2, 2), message.of_class);
    bytes[4] = message.instance;
    put(all.subspan(5, 4), message.command);
    put(all.subspan(9, 8), static_cast<std::uint64_t>(message.data));
    put(all.subspan(17, 8), message.address);
    return bytes;
}

std::optional<Message> decode_message(std::span<const std::uint8_t> report) {
    if (report.size() < report_bytes || report[0] != report_id) return std::nullopt;
    Message m;
    m.type = static_cast<Type>(report[1]);
    m.of_class = static_cast<std::uint16_t>(take(report.subspan(2, 2)));
    m.instance = report[4];
    m.command = static_cast<std::uint32_t>(take(report.subspan(5, 4)));
    m.data = static_cast<std::int64_t>(take(report.subspan(9, 8)));
    m.address = take(report.subspan(17, 8));
    return m;
}

std::optional<std::int64_t> reply_value(Command question, const Message& message) {
    if (message.type != Type::request || message.of_class != axis_class || message.instance != 0 ||
        message.command != static_cast<std::uint32_t>(question))
        return std::nullopt;
    return message.data;
}

}  // namespace bolt::device::board
