// HTML of the report pages: escaped text, numbers independent of the locale, the style sheet, and the frame
// of a page.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace bolt::plot {

// Appends formatted text.
template <class... Values>
void put(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

// Escapes text and attribute values for HTML and SVG. Replaces invalid UTF-8 and the control characters that
// XML forbids by U+FFFD.
std::string escape(std::string_view text);

// A number with the minus sign U+2212 and without "−0.0". A value that is not finite gives a dash.
std::string number(double value, int decimals);
std::string signed_number(double value, int decimals);  // "+2.0"

// "24.5 s", "3 min 25 s", "1 h 03 min 25 s"
std::string duration_text(double seconds);

// The style sheet of all pages and drawings, for light and dark screens and for paper.
std::string_view style_sheet();

// A complete document without external resources or scripts. `body`: HTML. `head`: HTML of further elements
// of the head.
std::string page(std::string_view title, std::string_view body, std::string_view head = {});

// A drawing with heading and caption; both are HTML and may be empty.
std::string figure(std::string_view heading, std::string_view svg, std::string_view caption);

// An entry of a list of facts, from plain text. An empty value gives an empty string. A path has a line of
// its own and breaks only after a '/'.
std::string fact(std::string_view name, std::string_view value);
std::string path_fact(std::string_view name, std::string_view path);

}  // namespace bolt::plot
