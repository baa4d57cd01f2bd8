// The quantile of a list of values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bolt {

// Returns the value below which the fraction `share` of the values lies; 0 without values.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto last = values.size() - 1;
    const auto at = std::min(last, static_cast<std::size_t>(share * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

}  // namespace bolt
