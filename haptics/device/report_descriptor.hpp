// What a HID device says about its reports: which bits of which report mean what. Read from the device, for
// devices of one class differ in all of it.
//
// USB-IF, Device Class Definition for Human Interface Devices 1.11, section 6.2.2; usages: HID Usage Tables.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::device {

enum class ReportKind : std::uint8_t { input, output, feature };

struct Usage {
    std::uint16_t page = 0, id = 0;
    friend bool operator==(const Usage&, const Usage&) = default;
};

// One value in a report, or one slot of an array of usages.
struct Field {
    ReportKind kind = ReportKind::input;
    std::uint8_t report = 0;                           // id; 0: reports are not numbered
    std::uint32_t bit = 0;                             // from the beginning of the report, behind its id byte
    std::uint8_t bits = 0;                             // 1 … 32
    Usage usage;                                       // of an array's slot the first that it can hold
    std::uint32_t slots = 0, usages = 1;               // of an array's slot: so many, from there in `slots`
    std::int64_t low = 0, high = 0;                    // logical: as the bits have it
    std::int64_t physical_low = 0, physical_high = 0;  // both 0: as logical
    std::int32_t exponent = 0;                         // of ten, of the physical unit
    std::uint32_t unit = 0;
    bool constant = false, array = false, relative = false, null_state = false;
    std::uint32_t collection = 0;  // index of the innermost
};

struct Collection {
    Usage usage;
    std::uint8_t type = 0;  // 0 physical, 1 application, 2 logical, …
    std::optional<std::uint32_t> parent;
};

struct ReportLength {
    ReportKind kind = ReportKind::input;
    std::uint8_t report = 0;
    std::uint32_t bits = 0;  // padding included
};

struct ReportDescriptor {
    std::vector<Collection> collections;
    std::vector<Field> fields;  // without padding, and without what is wider than 32 bits
    std::vector<Usage> slots;   // what arrays choose from
    std::vector<ReportLength> reports;
    bool numbered = false;
};

// Errors say at which byte and what is wrong there.
Result<ReportDescriptor> parse_report_descriptor(std::span<const std::uint8_t> bytes);

// Bytes of a report without its id byte; 0: there is none.
std::size_t report_size(const ReportDescriptor& descriptor, ReportKind kind, std::uint8_t report);

// The first field of a kind with a usage; within collections of a usage, where given.
const Field* find_field(const ReportDescriptor& descriptor, ReportKind kind, Usage usage,
                        std::optional<Usage> within = std::nullopt);

// A thing that a host chooses: one of an array's usages, or a bit of its own.
struct Choice {
    Field field;
    std::int64_t value = 0;  // to be put there
};
std::optional<Choice> find_choice(const ReportDescriptor& descriptor, ReportKind kind, Usage option,
                                  std::optional<Usage> within = std::nullopt);

// The value of a field in a report's bytes (without the id byte). None: the report is too short, or the
// device says that it has none (null state).
std::optional<std::int64_t> value_of(const Field& field, std::span<const std::uint8_t> report);

// Puts a value, brought into the field's range, into a report's bytes; false: the report is too short.
bool put_value(const Field& field, std::int64_t value, std::span<std::uint8_t> report);

// The share of the field's range, −1 … 1 for one that goes below zero and 0 … 1 else.
double share_of(const Field& field, std::int64_t value);

}  // namespace bolt::device
