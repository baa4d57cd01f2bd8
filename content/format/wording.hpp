// How messages show the names of a file, and what an author may have meant by one that is not there.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace bolt::content {

// A text of the file as a message shows it: quoted, cut when long, without control characters.
std::string in_quotes(std::string_view text);

// The one known name that is near enough to be what was meant; empty if none is, or several are as near.
std::string meant(std::string_view name, std::span<const std::string> known);

// "did you mean "x"?", or "expected one of a, b, c".
std::string suggest(std::string_view name, std::span<const std::string> known);

}  // namespace bolt::content
