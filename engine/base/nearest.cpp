#include "engine/base/nearest.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace bolt {

namespace {
int lower_case(char c) { return std::tolower(static_cast<unsigned char>(c)); }
}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> before(width), above(width), row(width);
    for (std::size_t j = 0; j < width; ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j < width; ++j) {
            const bool same = lower_case(a[i - 1]) == lower_case(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0U : 1U)});
            const bool swapped = i > 1 && j > 1 && lower_case(a[i - 1]) == lower_case(b[j - 2]) &&
                                 lower_case(a[i - 2]) == lower_case(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = above;
        above = row;
    }
    return above[b.size()];
}

std::string nearest(std::string_view name, std::span<const std::string> candidates) {
    constexpr std::size_t longest = 64;  // the cost is quadratic, and a longer name is hardly a misspelling
    if (name.empty() || name.size() > longest) return {};
    const std::size_t limit = std::max<std::size_t>(1, (name.size() + 1) / 3);
    std::string best;
    std::size_t best_distance = limit + 1;
    bool tie = false;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance > best_distance || distance > limit) continue;
        tie = distance == best_distance && (tie || candidate != best);  // duplicates are one candidate
        best_distance = distance;
        best = candidate;
    }
    return tie ? std::string() : best;  // a tie would only be a guess
}

}  // namespace bolt
