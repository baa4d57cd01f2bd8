// Text and numbers as a page shows them: escaped, and independent of the locale.
#pragma once

#include <string>
#include <string_view>

namespace bolt::plot {

// For HTML and SVG, text and attribute values alike. Bytes that are no UTF-8 and controls that XML forbids
// become U+FFFD.
std::string escape(std::string_view text);

// A number with a true minus sign and no "−0.0"; a dash for what is not a finite number.
std::string number(double value, int decimals);
std::string signed_number(double value, int decimals);  // "+2.0"

// "3 min 24.5 s"
std::string duration_text(double seconds);

}  // namespace bolt::plot
