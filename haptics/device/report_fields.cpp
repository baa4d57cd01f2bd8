// Finds the fields of a parsed report descriptor, and reads and writes their values in reports.
#include <algorithm>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

namespace {

constexpr std::uint16_t button_page = 0x09, max_buttons = 32;

bool is_within(const ReportDescriptor& descriptor, const ReportField& field, Usage usage) {
    if (descriptor.collections.empty()) return false;
    for (std::optional<std::uint32_t> at = field.collection; at; at = descriptor.collections[*at].parent)
        if (descriptor.collections[*at].usage == usage) return true;
    return false;
}

}  // namespace

std::size_t report_size(const ReportDescriptor& descriptor, ReportKind kind, std::uint8_t report) {
    for (const ReportLength& length : descriptor.reports)
        if (length.kind == kind && length.report == report) return (length.bits + 7) / 8;
    return 0;
}

const ReportField* find_field(const ReportDescriptor& descriptor, ReportKind kind, Usage usage,
                              std::optional<Usage> within) {
    for (const ReportField& f : descriptor.fields)
        if (f.kind == kind && f.usage == usage && (!within || is_within(descriptor, f, *within))) return &f;
    return nullptr;
}

std::optional<Selector> find_selector(const ReportDescriptor& descriptor, ReportKind kind, Usage option,
                                      std::optional<Usage> within) {
    for (const ReportField& f : descriptor.fields) {
        if (f.kind != kind || (within && !is_within(descriptor, f, *within))) continue;
        if (!f.array) {
            if (f.usage == option) return Selector{f, std::clamp<std::int64_t>(1, f.low, f.high)};
            continue;
        }
        for (std::uint32_t i = 0; i < f.usages; ++i)
            if (descriptor.slots[f.slots + i] == option) return Selector{f, f.low + i};
    }
    return std::nullopt;
}

std::optional<std::int64_t> value_of(const ReportField& field, std::span<const std::uint8_t> report) {
    if (field.bit + field.bits > 8 * report.size()) return std::nullopt;
    std::uint64_t raw = 0;
    const std::uint32_t first = field.bit / 8, last = (field.bit + field.bits - 1U) / 8;
    for (std::uint32_t i = first; i <= last; ++i)
        raw |= static_cast<std::uint64_t>(report[i]) << (8 * (i - first));
    raw = raw >> (field.bit % 8) & ((1ULL << field.bits) - 1);
    auto value = static_cast<std::int64_t>(raw);
    if (field.low < 0 && (raw >> (field.bits - 1U) & 1U) != 0) value -= std::int64_t{1} << field.bits;
    if (field.null_state && (value < field.low || value > field.high)) return std::nullopt;
    return value;
}

bool write_value(const ReportField& field, std::int64_t value, std::span<std::uint8_t> report) {
    if (field.bit + field.bits > 8 * report.size()) return false;
    const auto raw = static_cast<std::uint64_t>(std::clamp(value, field.low, field.high));
    for (std::uint32_t i = 0; i < field.bits; ++i) {
        const std::uint32_t bit = field.bit + i;
        const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
        std::uint8_t& byte = report[bit / 8];
        byte = static_cast<std::uint8_t>((raw >> i & 1U) != 0 ? byte | mask : byte & ~mask);
    }
    return true;
}

double normalized_value(const ReportField& field, std::int64_t value) {
    const auto v = static_cast<double>(std::clamp(value, field.low, field.high));
    const auto low = static_cast<double>(field.low), high = static_cast<double>(field.high);
    if (field.low < 0) return v / std::max(-low, high);
    return high > low ? (v - low) / (high - low) : 0.0;
}

std::vector<ReportField> find_button_fields(const ReportDescriptor& descriptor) {
    std::vector<ReportField> buttons;
    for (std::uint16_t number = 1; number <= max_buttons; ++number)
        if (const ReportField* button = find_field(descriptor, ReportKind::input, {button_page, number});
            button != nullptr && !button->array)
            buttons.push_back(*button);
    return buttons;
}

bool decode_buttons(const std::vector<ReportField>& buttons, std::uint8_t id,
                    std::span<const std::uint8_t> report, std::uint32_t& pressed) {
    bool decoded = false;
    for (const ReportField& button : buttons) {
        if (button.report != id) continue;
        const auto value = value_of(button, report);
        if (!value) continue;
        const std::uint32_t bit = 1U << (button.usage.id - 1U);
        pressed = *value != 0 ? pressed | bit : pressed & ~bit;
        decoded = true;
    }
    return decoded;
}

std::optional<std::uint8_t> strip_report_id(bool numbered, std::span<const std::uint8_t>& report) {
    if (!numbered) return std::uint8_t{0};
    if (report.empty()) return std::nullopt;
    const std::uint8_t id = report.front();
    report = report.subspan(1);
    return id;
}

}  // namespace bolt::device
