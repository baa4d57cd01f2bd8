// Suggests the valid name nearest to a misspelt one, for error messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace bolt {

// Edit distance with transpositions (optimal string alignment), ignoring ASCII case.
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the candidate nearest to `name`. Returns an empty string if no candidate is close enough, or if
// different candidates are equally near.
std::string nearest(std::string_view name, std::span<const std::string> candidates);

}  // namespace bolt
