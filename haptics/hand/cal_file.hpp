// Reads the calibration file of the vendor's software: a title line, then a heading and four lines for each
// finger and the palm. The sixth word of a line is a sensor's offset (counts), the ninth its gain (rad per
// count). The fourth line exists even for fingers without a fourth sensor; the gain of the middle finger's
// abduction is in the index finger's fourth line, where that software writes it.
#pragma once

#include <string>
#include <string_view>

#include "haptics/hand/glove_calibration.hpp"

namespace bolt::hand {

// Errors name `file`, line and column.
Result<Calibration> parse_cal(std::string_view text, const std::string& file);

}  // namespace bolt::hand
