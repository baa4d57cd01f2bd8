// Matching of names with patterns in which a star stands for any text.
#pragma once

#include <string_view>

namespace bolt {

// Returns true if the whole name matches the pattern. `equal(p, n)`: whether the character p of the pattern
// stands for the character n of the name.
template <class Equal>
bool matches_wildcard(std::string_view pattern, std::string_view name, const Equal& equal) {
    // Backtracking to the last star only: linear for typical patterns.
    std::size_t p = 0, n = 0, star = std::string_view::npos, from = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            from = n;
        } else if (p < pattern.size() && equal(pattern[p], name[n])) {
            ++p;
            ++n;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++from;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

}  // namespace bolt
