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

// The style sheet of every page and drawing: light, dark and paper, one accent, figures in columns.

std::string_view style_sheet();

// The frame of a page, and the few pieces that all pages use.

// A whole document, with nothing from outside and no script. `body` is HTML already.
std::string page(std::string_view title, std::string_view body);

// A drawing with its heading and caption; both are HTML already and may be empty.
std::string figure(std::string_view heading, std::string_view svg, std::string_view caption);

// An entry of a list of facts, from plain text; nothing for an empty value. A path takes a line of its own
// and breaks only after a '/'.
std::string fact(std::string_view name, std::string_view value);
std::string path_fact(std::string_view name, std::string_view path);

}  // namespace bolt::plot
