#include "haptics/device/report_descriptor.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::device {

namespace {

constexpr std::uint32_t max_value_bits = 32;           // per value
constexpr std::uint32_t max_field_bits = 256;          // bits; the standard allows 32, some devices use 64
constexpr std::uint32_t max_fields_per_item = 4096;    // fields declared by one item
constexpr std::uint32_t max_report_bits = 8 * 65536U;  // bits
constexpr std::size_t max_fields = 16384;
constexpr std::size_t max_slots = 65536;
constexpr std::size_t max_nesting = 32;

enum Tag : std::uint8_t {  // tag and type bits of the item's first byte
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

class DescriptorParser {
  public:
    explicit DescriptorParser(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    Result<ReportDescriptor> run() {
        while (at_ < bytes_.size()) {
            item_ = at_;
            const std::uint8_t head = bytes_[at_++];
            if (head == 0xfe) {  // a long item; none is defined by the standard
                if (at_ + 2 > bytes_.size() || at_ + 2 + bytes_[at_] > bytes_.size()) return truncated_item();
                at_ += 2U + bytes_[at_];
                continue;
            }
            const std::size_t size = (head & 3U) == 3 ? 4 : head & 3U;
            if (at_ + size > bytes_.size()) return truncated_item();
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < size; ++i)
                value |= static_cast<std::uint32_t>(bytes_[at_ + i]) << (8 * i);
            at_ += size;
            BOLT_TRY(apply_item(head & 0xfcU, value, size));
        }
        item_ = at_;
        if (!open_.empty())
            return error_at_item("a collection is not ended",
                                 "as many End Collection items as Collection items");
        if (descriptor_.fields.empty())
            return error_at_item("the descriptor has no fields", "an Input, Output or Feature item");
        return std::move(descriptor_);
    }

  private:
    [[nodiscard]] tl::unexpected<Error> error_at_item(std::string what, std::string expected) const {
        return fail(ErrorCode::no_device, fmt::format("report descriptor, byte {}: {}", item_, what),
                    std::move(expected));
    }
    [[nodiscard]] tl::unexpected<Error> truncated_item() const {
        return error_at_item("it ends within an item",
                             "as many bytes after the first byte of an item as that byte states");
    }

    static std::int64_t signed_of(std::uint32_t value, std::size_t size) {
        if (size == 1) return static_cast<std::int8_t>(value);
        if (size == 2) return static_cast<std::int16_t>(value);
        return static_cast<std::int32_t>(value);
    }
    // A value of one byte below 16 is a signed number of four bits.
    static std::int32_t exponent_of(std::uint32_t value, std::size_t size) {
        if (size != 1 || value >= 16) return static_cast<std::int32_t>(signed_of(value, size));
        const auto nibble = static_cast<std::int32_t>(value);
        return nibble > 7 ? nibble - 16 : nibble;
    }
    [[nodiscard]] Usage usage_of(std::uint32_t value, std::size_t size) const {
        if (size == 4) return {static_cast<std::uint16_t>(value >> 16U), static_cast<std::uint16_t>(value)};
        return {globals_.page, static_cast<std::uint16_t>(value)};
    }

    Status apply_item(unsigned tag, std::uint32_t value, std::size_t size) {
        switch (tag >> 2U & 3U) {  // the type of the item
            case 0:
                return apply_main_item(tag, value);
            case 1:
                return apply_global_item(tag, value, size);
            case 2:
                return apply_local_item(tag, value, size);
            default:
                return {};  // reserved by the standard
        }
    }

    Status apply_main_item(unsigned tag, std::uint32_t value) {
        switch (tag) {
            case input:
                return add_fields(ReportKind::input, value);
            case output:
                return add_fields(ReportKind::output, value);
            case feature:
                return add_fields(ReportKind::feature, value);
            case collection:
                return open_collection(value);
            case end_collection:
                return close_collection();
            default:
                return {};
        }
    }

    Status open_collection(std::uint32_t type) {
        if (open_.size() == max_nesting)
            return error_at_item("collections are nested too deeply", "at most 32 levels");
        const Usage first = locals_.usages.empty() ? Usage{} : locals_.usages.front();
        descriptor_.collections.push_back({first, static_cast<std::uint8_t>(type),
                                           open_.empty() ? std::nullopt : std::optional(open_.back())});
        open_.push_back(static_cast<std::uint32_t>(descriptor_.collections.size() - 1));
        locals_ = {};
        return {};
    }

    Status close_collection() {
        if (open_.empty())
            return error_at_item("a collection ends that was not begun",
                                 "a Collection item before each End Collection item");
        open_.pop_back();
        locals_ = {};
        return {};
    }

    Status apply_global_item(unsigned tag, std::uint32_t value, std::size_t size) {
        switch (tag) {
            case usage_page:
                globals_.page = static_cast<std::uint16_t>(value);
                return {};
            case logical_low:
                globals_.low = signed_of(value, size);
                return {};
            case logical_high:
                globals_.high = signed_of(value, size);
                globals_.high_as_unsigned = value;
                return {};
            case physical_low:
                globals_.physical_low = signed_of(value, size);
                return {};
            case physical_high:
                globals_.physical_high = signed_of(value, size);
                globals_.physical_high_as_unsigned = value;
                return {};
            case unit_exponent:
                globals_.exponent = exponent_of(value, size);
                return {};
            case unit:
                globals_.unit = value;
                return {};
            case report_bits:
                globals_.bits = value;
                return {};
            case report_count:
                globals_.count = value;
                return {};
            case report_id:
                return set_report_id(value);
            case push:
                return push_globals();
            case pop:
                return pop_globals();
            default:
                return {};
        }
    }

    Status set_report_id(std::uint32_t id) {
        if (id == 0 || id > 255) return error_at_item(fmt::format("the report id is {}", id), "1 … 255");
        if (!descriptor_.numbered && !descriptor_.fields.empty())
            return error_at_item("a report id after reports without one",
                                 "a Report ID item before the first report, or none at all");
        globals_.report = static_cast<std::uint8_t>(id);
        descriptor_.numbered = true;
        return {};
    }

    Status push_globals() {
        if (global_stack_.size() == max_nesting)
            return error_at_item("too many nested Push items", "at most 32 levels");
        global_stack_.push_back(globals_);
        return {};
    }

    Status pop_globals() {
        if (global_stack_.empty())
            return error_at_item("a Pop item without a Push item", "a Push item before each Pop item");
        globals_ = global_stack_.back();
        global_stack_.pop_back();
        return {};
    }

    Status apply_local_item(unsigned tag, std::uint32_t value, std::size_t size) {
        switch (tag) {
            case usage:
                return add_usage(usage_of(value, size));
            case usage_low:
                locals_.low = usage_of(value, size);
                return {};
            case usage_high:
                return add_usage_range(usage_of(value, size));
            default:
                return {};  // designators, strings and delimiters are not needed
        }
    }

    // Adds the usages from the last Usage Minimum to `high`.
    Status add_usage_range(const Usage& high) {
        if (!locals_.low || locals_.low->page != high.page || high.id < locals_.low->id)
            return error_at_item("a range of usages ends before it begins",
                                 "a Usage Minimum of the same page that does not exceed it");
        for (std::uint32_t id = locals_.low->id; id <= high.id; ++id)
            BOLT_TRY(add_usage({high.page, static_cast<std::uint16_t>(id)}));
        locals_.low.reset();
        return {};
    }

    Status add_usage(const Usage& one) {
        if (locals_.usages.size() == 65536)
            return error_at_item("too many usages", "at most 65536 for one item");
        locals_.usages.push_back(one);
        return {};
    }

    std::uint32_t& bits_of(ReportKind kind) {
        for (ReportLength& length : descriptor_.reports)
            if (length.kind == kind && length.report == globals_.report) return length.bits;
        return descriptor_.reports.emplace_back(ReportLength{kind, globals_.report, 0}).bits;
    }

    [[nodiscard]] Status check_sizes(bool constant) const {
        if (globals_.count > max_fields_per_item)
            return error_at_item(fmt::format("one item declares {} fields", globals_.count),
                                 "a Report Count of at most 4096");
        if (globals_.bits > max_field_bits && !constant)
            return error_at_item(fmt::format("a field of {} bits", globals_.bits),
                                 "a Report Size of at most 256 bits");
        if (globals_.bits > max_report_bits)
            return error_at_item(fmt::format("padding of {} bits", globals_.bits),
                                 "a report of at most 64 KiB");
        return {};
    }

    // A field of the present item, without its offset and usages. `flags`: the data of the item.
    [[nodiscard]] ReportField make_field(ReportKind kind, std::uint32_t flags) const {
        const Global& g = globals_;
        ReportField field;
        field.kind = kind;
        field.report = g.report;
        field.bits = static_cast<std::uint8_t>(std::min(g.bits, max_value_bits));
        field.low = g.low;
        // Some devices encode an unsigned maximum as signed (0xff in one byte for 255).
        field.high = g.high < g.low && g.low >= 0 ? g.high_as_unsigned : g.high;
        field.physical_low = g.physical_low;
        field.physical_high = g.physical_high < g.physical_low && g.physical_low >= 0
                                  ? g.physical_high_as_unsigned
                                  : g.physical_high;
        field.exponent = g.exponent;
        field.unit = g.unit;
        field.array = (flags & 2U) == 0;
        field.relative = (flags & 4U) != 0;
        field.null_state = (flags & 64U) != 0;
        field.collection = open_.empty() ? 0 : open_.back();
        return field;
    }

    // Stores the usages that the slots of an array can hold.
    Status add_slots(ReportField& field) {
        if (locals_.usages.empty()) return {};
        if (descriptor_.slots.size() + locals_.usages.size() > max_slots)
            return error_at_item("too many usages in arrays", "at most 65536 in the descriptor");
        field.slots = static_cast<std::uint32_t>(descriptor_.slots.size());
        descriptor_.slots.insert(descriptor_.slots.end(), locals_.usages.begin(), locals_.usages.end());
        return {};
    }

    // Sets the usages of field `i` of the present item. The last usage holds for all further fields.
    void set_usages(ReportField& field, std::uint32_t i) const {
        if (locals_.usages.empty()) {
            field.usage = {globals_.page, 0};
            field.usages = field.array ? 0 : 1;
        } else if (field.array) {
            field.usage = locals_.usages.front();
            field.usages = static_cast<std::uint32_t>(locals_.usages.size());
        } else {
            field.usage = locals_.usages[std::min<std::size_t>(i, locals_.usages.size() - 1)];
        }
    }

    Status add_fields(ReportKind kind, std::uint32_t flags) {
        if (globals_.count == 0 || globals_.bits == 0) {
            locals_ = {};
            return {};
        }
        const bool constant = (flags & 1U) != 0;
        BOLT_TRY(check_sizes(constant));
        ReportField field = make_field(kind, flags);
        if (!constant && field.high < field.low)
            return error_at_item(fmt::format("values from {} to {}", field.low, field.high),
                                 "a Logical Minimum that does not exceed the Logical Maximum");
        if (field.array && !constant) BOLT_TRY(add_slots(field));
        std::uint32_t& bit = bits_of(kind);
        for (std::uint32_t i = 0; i < globals_.count; ++i) {
            field.bit = bit;
            bit += globals_.bits;
            if (bit > max_report_bits) return error_at_item("a report of more than 64 KiB", "at most 64 KiB");
            if (constant || globals_.bits > max_value_bits) continue;
            if (descriptor_.fields.size() == max_fields)
                return error_at_item("too many fields", "at most 16384 in the descriptor");
            set_usages(field, i);
            descriptor_.fields.push_back(field);
        }
        locals_ = {};
        return {};
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0, item_ = 0;
    ReportDescriptor descriptor_;
    std::vector<std::uint32_t> open_;
    Global globals_;
    std::vector<Global> global_stack_;
    Local locals_;
};

}  // namespace

Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes) {
    return DescriptorParser(bytes).run();
}

}  // namespace bolt::device
