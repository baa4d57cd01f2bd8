// The frame of a page, and the few pieces that all pages use.
#pragma once

#include <string>
#include <string_view>

namespace bolt::plot {

// A whole document, with nothing from outside and no script. `body` is HTML already.
std::string page(std::string_view title, std::string_view body);

// A drawing with its heading and caption; both are HTML already and may be empty.
std::string figure(std::string_view heading, std::string_view svg, std::string_view caption);

// An entry of a list of facts, from plain text; nothing for an empty value. A path takes a line of its own
// and breaks only after a '/'.
std::string fact(std::string_view name, std::string_view value);
std::string path_fact(std::string_view name, std::string_view path);

}  // namespace bolt::plot
