// Scales: a range, and ticks on it that a person can read.
#pragma once

#include <vector>

namespace bolt::plot {

struct Range {
    double low = 0.0;
    double high = 1.0;
    [[nodiscard]] double span() const { return high - low; }
};

struct Ticks {
    std::vector<double> at;  // rising
    int decimals = 0;        // that tell neighbouring ticks apart
    Range range;             // what the ticks, or the caller, ask to be drawn
};

// Ticks 1, 2, 2.5 or 5 · 10ⁿ apart, about `about` of them, whose first and last cover [low, high].
Ticks covering_ticks(double low, double high, int about = 5);

// Ticks inside the range, which stays as it is. Degrees step by divisors and multiples of a turn (…, 15, 30,
// 45, 90 …).
Ticks inner_ticks(Range range, int about = 6);
Ticks degree_ticks(Range range, int about = 6);

// Whole numbers low … high, thinned to at most `most`: attempts, counts.
Ticks count_ticks(int low, int high, int most = 12);

}  // namespace bolt::plot
