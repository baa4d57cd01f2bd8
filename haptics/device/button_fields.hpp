// Finds and decodes the buttons of a HID device.
#pragma once

#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

// One-bit fields of the Button page, sorted by button number.
std::vector<Field> find_button_fields(const ReportDescriptor& descriptor);

// Decodes a report without its id into `pressed` (bit i: button i). Returns false if it contains no buttons.
bool decode_buttons(const std::vector<Field>& buttons, std::uint8_t id, std::span<const std::uint8_t> report,
                    std::uint32_t& pressed);

// Removes the id that hidapi puts in front of a report and returns it; 0 if reports are not numbered, nullopt
// if the id is missing.
std::optional<std::uint8_t> strip_report_id(bool numbered, std::span<const std::uint8_t>& report);

}  // namespace bolt::device
