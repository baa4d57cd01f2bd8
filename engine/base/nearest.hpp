// The nearest valid name to a misspelt one, for error messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace bolt {

// Edit distance with transpositions (optimal string alignment), ignoring ASCII case.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `name`, or an empty string if none, or more than one, is near
// enough to be what was meant.
std::string nearest(std::string_view name, std::span<const std::string> candidates);

}  // namespace bolt
