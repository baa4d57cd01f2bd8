// The buttons of a HID device: where its reports say which are pressed.
#pragma once

#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

// In the order of their numbers, those that have a bit below.
std::vector<Field> button_fields(const ReportDescriptor& descriptor);

// What a report (its id taken off) tells of them: a bit each. False: nothing.
bool take_buttons(const std::vector<Field>& buttons, std::uint8_t id, std::span<const std::uint8_t> report,
                  std::uint32_t& pressed);

// Takes the id off a report as hidapi gives it; 0 where reports are not numbered. None: it is empty and
// should have one.
std::optional<std::uint8_t> take_id(bool numbered, std::span<const std::uint8_t>& report);

}  // namespace bolt::device
