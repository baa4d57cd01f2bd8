// Median and quartiles of a few values.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace bolt::analysis {

// Of type 7 (Hyndman and Fan, Am. Stat. 50 (1996) 361), NumPy's and R's default: straight between the values.
struct Quartiles {
    double low = std::numeric_limits<double>::quiet_NaN(), median = low, high = low;
    std::size_t n = 0;
};

// What is not finite does not count; of nothing all are NaN.
Quartiles quartiles(std::vector<double> values);

}  // namespace bolt::analysis
