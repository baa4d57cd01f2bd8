// What an author may have meant by a name that is not there.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace bolt::content {

// The one known name that is near enough to be what was meant; empty if none is, or several are as near.
std::string meant(std::string_view name, std::span<const std::string> known);

// "did you mean "x"?", or "expected one of a, b, c".
std::string suggest(std::string_view name, std::span<const std::string> known);

}  // namespace bolt::content
