// The minimum and maximum of a series of values.
#pragma once

#include <algorithm>

namespace bolt::test {

struct Range {
    double low = 1e9, high = -1e9;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    [[nodiscard]] double width() const { return std::max(0.0, high - low); }
};

}  // namespace bolt::test
