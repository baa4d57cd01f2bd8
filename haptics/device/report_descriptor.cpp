#include "haptics/device/report_descriptor.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::device {

namespace {

constexpr std::uint32_t most_bits = 32;               // that a value has
constexpr std::uint32_t widest_field = 256;           // the standard says 32; there are devices with 64
constexpr std::uint32_t most_count = 4096;            // fields that one item may declare
constexpr std::uint32_t longest_report = 8 * 65536U;  // bits
constexpr std::size_t most_fields = 16384;
constexpr std::size_t most_slots = 65536;
constexpr std::size_t deepest = 32;

enum Tag : std::uint8_t {  // with the type, as in the item's first byte without its size
    input = 0x80,
    output = 0x90,
    feature = 0xb0,
    collection = 0xa0,
    end_collection = 0xc0,
    usage_page = 0x04,
    logical_low = 0x14,
    logical_high = 0x24,
    physical_low = 0x34,
    physical_high = 0x44,
    unit_exponent = 0x54,
    unit = 0x64,
    report_bits = 0x74,
    report_id = 0x84,
    report_count = 0x94,
    push = 0xa4,
    pop = 0xb4,
    usage = 0x08,
    usage_low = 0x18,
    usage_high = 0x28,
    delimiter = 0xa8,
};

struct Global {
    std::uint16_t page = 0;
    std::int64_t low = 0, high = 0, physical_low = 0, physical_high = 0;
    std::uint32_t high_as_unsigned = 0, physical_high_as_unsigned = 0;
    std::int32_t exponent = 0;
    std::uint32_t unit = 0, bits = 0, count = 0;
    std::uint8_t report = 0;
};

struct Local {
    std::vector<Usage> usages;
    std::optional<Usage> low;
};

class Parser {
  public:
    explicit Parser(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    Result<ReportDescriptor> run() {
        while (at_ < bytes_.size()) {
            item_ = at_;
            const std::uint8_t head = bytes_[at_++];
            if (head == 0xfe) {  // a long item: nobody defined one
                if (at_ + 2 > bytes_.size() || at_ + 2 + bytes_[at_] > bytes_.size()) return cut_off();
                at_ += 2U + bytes_[at_];
                continue;
            }
            const std::size_t size = (head & 3U) == 3 ? 4 : head & 3U;
            if (at_ + size > bytes_.size()) return cut_off();
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < size; ++i)
                value |= static_cast<std::uint32_t>(bytes_[at_ + i]) << (8 * i);
            at_ += size;
            BOLT_TRY(take(head & 0xfcU, value, size));
        }
        item_ = at_;
        if (!open_.empty()) return wrong("a collection is not ended", "an end of each collection");
        if (made_.fields.empty()) return wrong("the descriptor has no fields", "a report");
        return std::move(made_);
    }

  private:
    [[nodiscard]] tl::unexpected<Error> wrong(std::string what, std::string expected) const {
        return fail(ErrorCode::no_device, fmt::format("report descriptor, byte {}: {}", item_, what),
                    std::move(expected));
    }
    [[nodiscard]] tl::unexpected<Error> cut_off() const {
        return wrong("it ends within an item", "a whole item");
    }

    static std::int64_t signed_of(std::uint32_t value, std::size_t size) {
        if (size == 1) return static_cast<std::int8_t>(value);
        if (size == 2) return static_cast<std::int16_t>(value);
        return static_cast<std::int32_t>(value);
    }
    [[nodiscard]] Usage usage_of(std::uint32_t value, std::size_t size) const {
        if (size == 4) return {static_cast<std::uint16_t>(value >> 16U), static_cast<std::uint16_t>(value)};
        return {now_.page, static_cast<std::uint16_t>(value)};
    }

    Status take(unsigned tag, std::uint32_t value, std::size_t size) {
        switch (tag) {
            case input:
                return add_fields(ReportKind::input, value);
            case output:
                return add_fields(ReportKind::output, value);
            case feature:
                return add_fields(ReportKind::feature, value);
            case collection: {
                if (open_.size() == deepest)
                    return wrong("collections in each other without end", "at most 32");
                const Usage first = local_.usages.empty() ? Usage{} : local_.usages.front();
                made_.collections.push_back({first, static_cast<std::uint8_t>(value),
                                             open_.empty() ? std::nullopt : std::optional(open_.back())});
                open_.push_back(static_cast<std::uint32_t>(made_.collections.size() - 1));
                local_ = {};
                return {};
            }
            case end_collection:
                if (open_.empty()) return wrong("the end of a collection that was not begun", "a collection");
                open_.pop_back();
                local_ = {};
                return {};
            case usage_page:
                now_.page = static_cast<std::uint16_t>(value);
                return {};
            case logical_low:
                now_.low = signed_of(value, size);
                return {};
            case logical_high:
                now_.high = signed_of(value, size);
                now_.high_as_unsigned = value;
                return {};
            case physical_low:
                now_.physical_low = signed_of(value, size);
                return {};
            case physical_high:
                now_.physical_high = signed_of(value, size);
                now_.physical_high_as_unsigned = value;
                return {};
            case unit_exponent: {
                const auto nibble = static_cast<std::int32_t>(value & 0xfU);
                now_.exponent = size == 1 && value < 16 ? (nibble > 7 ? nibble - 16 : nibble)
                                                        : static_cast<std::int32_t>(signed_of(value, size));
                return {};
            }
            case unit:
                now_.unit = value;
                return {};
            case report_bits:
                now_.bits = value;
                return {};
            case report_count:
                now_.count = value;
                return {};
            case report_id:
                if (value == 0 || value > 255)
                    return wrong(fmt::format("the report id {}", value), "1 … 255");
                if (!made_.numbered && !made_.fields.empty())
                    return wrong("a report id after reports without one", "ids for all reports or for none");
                now_.report = static_cast<std::uint8_t>(value);
                made_.numbered = true;
                return {};
            case push:
                if (pushed_.size() == deepest) return wrong("more pushed than can be", "at most 32");
                pushed_.push_back(now_);
                return {};
            case pop:
                if (pushed_.empty()) return wrong("a pop without a push", "a push before it");
                now_ = pushed_.back();
                pushed_.pop_back();
                return {};
            case usage:
                return add_usage(usage_of(value, size));
            case usage_low:
                local_.low = usage_of(value, size);
                return {};
            case usage_high: {
                const Usage high = usage_of(value, size);
                if (!local_.low || local_.low->page != high.page || high.id < local_.low->id)
                    return wrong("a range of usages that ends before it begins", "its least usage first");
                for (std::uint32_t id = local_.low->id; id <= high.id; ++id)
                    BOLT_TRY(add_usage({high.page, static_cast<std::uint16_t>(id)}));
                local_.low.reset();
                return {};
            }
            default:
                return {};  // designators, strings, delimiters: nothing that we need
        }
    }

    Status add_usage(const Usage& one) {
        if (local_.usages.size() == 65536) return wrong("more usages than there are", "at most 65536");
        local_.usages.push_back(one);
        return {};
    }

    std::uint32_t& bits_of(ReportKind kind) {
        for (ReportLength& length : made_.reports)
            if (length.kind == kind && length.report == now_.report) return length.bits;
        return made_.reports.emplace_back(ReportLength{kind, now_.report, 0}).bits;
    }

    Status add_fields(ReportKind kind, std::uint32_t flags) {
        if (now_.count == 0 || now_.bits == 0) {
            local_ = {};
            return {};
        }
        const bool constant = (flags & 1U) != 0;
        if (now_.count > most_count)
            return wrong(fmt::format("{} fields at once", now_.count), "at most 4096");
        if (now_.bits > widest_field && !constant)
            return wrong(fmt::format("a field of {} bits", now_.bits), "at most 256");
        if (now_.bits > longest_report) return wrong(fmt::format("a field of {} bits", now_.bits), "less");
        std::uint32_t& bit = bits_of(kind);
        Field field;
        field.kind = kind;
        field.report = now_.report;
        field.bits = static_cast<std::uint8_t>(std::min(now_.bits, most_bits));
        field.low = now_.low;
        // Some devices encode an unsigned maximum as signed (0xff in one byte for 255).
        field.high = now_.high < now_.low && now_.low >= 0 ? now_.high_as_unsigned : now_.high;
        field.physical_low = now_.physical_low;
        field.physical_high = now_.physical_high < now_.physical_low && now_.physical_low >= 0
                                  ? now_.physical_high_as_unsigned
                                  : now_.physical_high;
        field.exponent = now_.exponent;
        field.unit = now_.unit;
        field.constant = constant;
        field.array = (flags & 2U) == 0;
        field.relative = (flags & 4U) != 0;
        field.null_state = (flags & 64U) != 0;
        field.collection = open_.empty() ? 0 : open_.back();
        if (!constant && field.high < field.low)
            return wrong(fmt::format("values from {} to {}", field.low, field.high), "the least first");
        if (field.array && !constant && !local_.usages.empty()) {
            if (made_.slots.size() + local_.usages.size() > most_slots)
                return wrong("arrays of more usages than anybody chooses from", "at most 65536");
            field.slots = static_cast<std::uint32_t>(made_.slots.size());
            made_.slots.insert(made_.slots.end(), local_.usages.begin(), local_.usages.end());
        }
        for (std::uint32_t i = 0; i < now_.count; ++i) {
            field.bit = bit;
            bit += now_.bits;
            if (bit > longest_report) return wrong("a report of more than 64 KiB", "a shorter one");
            if (constant || now_.bits > most_bits) continue;
            if (made_.fields.size() == most_fields)
                return wrong("more fields than anybody reads", "at most 16384");
            if (local_.usages.empty()) {
                field.usage = {now_.page, 0};
                field.usages = field.array ? 0 : 1;
            } else if (field.array) {
                field.usage = local_.usages.front();
                field.usages = static_cast<std::uint32_t>(local_.usages.size());
            } else {
                field.usage = local_.usages[std::min<std::size_t>(i, local_.usages.size() - 1)];
            }
            made_.fields.push_back(field);
        }
        local_ = {};
        return {};
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0, item_ = 0;
    ReportDescriptor made_;
    std::vector<std::uint32_t> open_;
    Global now_;
    std::vector<Global> pushed_;
    Local local_;
};

bool is_within(const ReportDescriptor& descriptor, const Field& field, Usage usage) {
    if (descriptor.collections.empty()) return false;
    for (std::optional<std::uint32_t> at = field.collection; at; at = descriptor.collections[*at].parent)
        if (descriptor.collections[*at].usage == usage) return true;
    return false;
}

}  // namespace

Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes) {
    return Parser(bytes).run();
}

std::size_t report_size(const ReportDescriptor& descriptor, ReportKind kind, std::uint8_t report) {
    for (const ReportLength& length : descriptor.reports)
        if (length.kind == kind && length.report == report) return (length.bits + 7) / 8;
    return 0;
}

const Field* find_field(const ReportDescriptor& descriptor, ReportKind kind, Usage usage,
                        std::optional<Usage> within) {
    for (const Field& f : descriptor.fields)
        if (f.kind == kind && f.usage == usage && (!within || is_within(descriptor, f, *within))) return &f;
    return nullptr;
}

std::optional<Selector> find_selector(const ReportDescriptor& descriptor, ReportKind kind, Usage option,
                                      std::optional<Usage> within) {
    for (const Field& f : descriptor.fields) {
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

std::optional<std::int64_t> value_of(const Field& field, std::span<const std::uint8_t> report) {
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

bool write_value(const Field& field, std::int64_t value, std::span<std::uint8_t> report) {
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

double normalized_value(const Field& field, std::int64_t value) {
    const auto v = static_cast<double>(std::clamp(value, field.low, field.high));
    const auto low = static_cast<double>(field.low), high = static_cast<double>(field.high);
    if (field.low < 0 && field.high > 0) return v / std::max(-low, high);
    return high > low ? (v - low) / (high - low) : 0.0;
}

namespace {

constexpr std::uint16_t button_page = 0x09, most_buttons = 32;

}  // namespace

std::vector<Field> find_button_fields(const ReportDescriptor& descriptor) {
    std::vector<Field> buttons;
    for (std::uint16_t number = 1; number <= most_buttons; ++number)
        if (const Field* button = find_field(descriptor, ReportKind::input, {button_page, number});
            button != nullptr && !button->array)
            buttons.push_back(*button);
    return buttons;
}

bool decode_buttons(const std::vector<Field>& buttons, std::uint8_t id, std::span<const std::uint8_t> report,
                    std::uint32_t& pressed) {
    bool told = false;
    for (const Field& button : buttons) {
        if (button.report != id) continue;
        const auto value = value_of(button, report);
        if (!value) continue;
        const std::uint32_t bit = 1U << (button.usage.id - 1U);
        pressed = *value != 0 ? pressed | bit : pressed & ~bit;
        told = true;
    }
    return told;
}

std::optional<std::uint8_t> strip_report_id(bool numbered, std::span<const std::uint8_t>& report) {
    if (!numbered) return std::uint8_t{0};
    if (report.empty()) return std::nullopt;
    const std::uint8_t id = report.front();
    report = report.subspan(1);
    return id;
}

}  // namespace bolt::device
