// The calibration file of the vendor's software: a line of title, then for each finger and the palm a heading
// and four lines, of which the sixth word is a sensor's offset (counts) and the ninth its gain (rad a count).
// Where a finger has no fourth sensor the line is there all the same; the gain of the middle finger's
// abduction is found on the index finger's, where that software puts it.
#pragma once

#include <string>
#include <string_view>

#include "haptics/glove/calibration.hpp"

namespace bolt::glove {

// Errors name `file`, the line and the column of the word that is wrong.
Result<Calibration> parse_cal(std::string_view text, const std::string& file);

}  // namespace bolt::glove
