// Parses a HID report descriptor, which states the meaning of the bits of each report, and decodes reports
// with it (report_fields.cpp). Devices of one class differ in their reports, so drivers read the descriptor
// from the device.
//
// Source: USB-IF, Device Class Definition for Human Interface Devices 1.11, section 6.2.2; usages: HID Usage
// Tables.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::device {

enum class ReportKind : std::uint8_t { input, output, feature };

// The meaning of a value, as a page and a number of the HID Usage Tables.
struct Usage {
    std::uint16_t page = 0, id = 0;
    friend bool operator==(const Usage&, const Usage&) = default;
};

// One value in a report, or one slot of an array. A slot of an array holds the number of one of the array's
// usages, such as the key that is pressed.
struct ReportField {
    ReportKind kind = ReportKind::input;
    std::uint8_t report = 0;  // report id; 0: reports are not numbered
    std::uint32_t bit = 0;    // offset after the id byte
    std::uint8_t bits = 0;    // 1 … 32
    Usage usage;              // for an array slot the first usage that it can hold
    // For an array slot: first index and count of its usages in ReportDescriptor::slots.
    std::uint32_t slots = 0, usages = 1;
    std::int64_t low = 0, high = 0;                    // logical range
    std::int64_t physical_low = 0, physical_high = 0;  // both 0: same as logical
    std::int32_t exponent = 0;                         // power of ten of the physical unit
    std::uint32_t unit = 0;                            // code of the HID standard; 0: no unit
    // array: the field is a slot of an array. relative: the value is the change since the last report.
    // null_state: a value outside the logical range means that there is no value.
    bool array = false, relative = false, null_state = false;
    std::uint32_t collection = 0;  // index of the innermost collection
};

// A group of fields, such as all fields of a joystick.
struct Collection {
    Usage usage;
    std::uint8_t type = 0;                // 0 physical, 1 application, 2 logical, …
    std::optional<std::uint32_t> parent;  // index of the collection that contains this one
};

struct ReportLength {
    ReportKind kind = ReportKind::input;
    std::uint8_t report = 0;
    std::uint32_t bits = 0;  // padding included
};

struct ReportDescriptor {
    std::vector<Collection> collections;
    std::vector<ReportField> fields;  // padding and fields wider than 32 bits are left out
    std::vector<Usage> slots;         // usages that array slots can hold
    std::vector<ReportLength> reports;
    bool numbered = false;  // reports begin with an id
};

// Errors name the byte offset.
Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes);

// Bytes of a report without its id; 0 if the report does not exist.
std::size_t report_size(const ReportDescriptor& descriptor, ReportKind kind, std::uint8_t report);

// The first field with this kind and usage, inside a collection of usage `within` if given; nullptr if none.
const ReportField* find_field(const ReportDescriptor& descriptor, ReportKind kind, Usage usage,
                              std::optional<Usage> within = std::nullopt);

// An option that the host selects: a usage of an array, or a one-bit field.
struct Selector {
    ReportField field;
    std::int64_t value = 0;  // value that selects it
};
// The first option with this kind and usage, inside a collection of usage `within` if given; nullopt if none.
std::optional<Selector> find_selector(const ReportDescriptor& descriptor, ReportKind kind, Usage option,
                                      std::optional<Usage> within = std::nullopt);

// The value of a field in a report without id. nullopt: the report is too short, or the value is the null
// state.
std::optional<std::int64_t> value_of(const ReportField& field, std::span<const std::uint8_t> report);

// Clamps the value to the field's range and writes it into a report without id. Returns false if the report
// is too short.
bool write_value(const ReportField& field, std::int64_t value, std::span<std::uint8_t> report);

// Normalises a value of the logical range. If the range includes negative values, the value is divided by the
// largest magnitude, which gives −1 … 1 and keeps the sign; otherwise the range is mapped to 0 … 1.
double normalized_value(const ReportField& field, std::int64_t value);

// One-bit fields of the Button page, sorted by button number.
std::vector<ReportField> find_button_fields(const ReportDescriptor& descriptor);

// Decodes a report without its id into `pressed` (bit 0: HID button 1). Returns false if it contains no
// buttons.
bool decode_buttons(const std::vector<ReportField>& buttons, std::uint8_t id,
                    std::span<const std::uint8_t> report, std::uint32_t& pressed);

// Removes the id that hidapi puts in front of a report and returns it; 0 if reports are not numbered, nullopt
// if the id is missing.
std::optional<std::uint8_t> strip_report_id(bool numbered, std::span<const std::uint8_t>& report);

}  // namespace bolt::device
