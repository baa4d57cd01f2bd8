// A histogram of durations with bins that grow with the value, from nanoseconds to minutes. Fixed size, no
// allocation. Log-linear bins as in HdrHistogram.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace bolt::servo {

// Bins of 1 ns below 32 ns, then 16 bins per octave: the relative resolution is 1/16.
struct Histogram {
    static constexpr int fine = 4;  // bits of a value below its leading bit that select the bin
    static constexpr std::uint64_t most = (1ULL << 40) - 1;  // ns, 18 minutes; longer durations count as this
    static constexpr std::size_t bins = (40 - fine + 1) << fine;

    std::array<std::uint64_t, bins> counts{};
    std::uint64_t count = 0;
    std::uint64_t least = most, greatest = 0;  // ns, exact
    double sum = 0.0;                          // ns
};

constexpr std::size_t bin_of(std::uint64_t ns) {
    const int octave = std::max(0, static_cast<int>(std::bit_width(ns)) - 1 - Histogram::fine);
    return (static_cast<std::size_t>(octave) << Histogram::fine) + static_cast<std::size_t>(ns >> octave);
}

// The first value, ns, of the next bin.
constexpr std::uint64_t end_of(std::size_t bin) {
    constexpr std::size_t linear = 2U << Histogram::fine;
    if (bin < linear) return bin + 1;
    const std::size_t octave = (bin >> Histogram::fine) - 1;
    return (static_cast<std::uint64_t>(bin - (octave << Histogram::fine)) + 1) << octave;
}

// Negative durations, from a clock that went backwards, count as 0.
inline void add(Histogram& h, std::int64_t ns) {
    const std::uint64_t value = std::min(static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0)), h.most);
    ++h.counts[bin_of(value)];
    ++h.count;
    h.least = std::min(h.least, value);
    h.greatest = std::max(h.greatest, value);
    h.sum += static_cast<double>(value);
}

inline void add(Histogram& h, const Histogram& other) {
    for (std::size_t i = 0; i < h.bins; ++i) h.counts[i] += other.counts[i];
    h.count += other.count;
    h.least = std::min(h.least, other.least);
    h.greatest = std::max(h.greatest, other.greatest);
    h.sum += other.sum;
}

// The duration, s, that a share (0 … 1) of all values does not exceed. Overestimates by at most 1/16, never
// underestimates. 0 if the histogram is empty.
inline double quantile(const Histogram& h, double share) {
    if (h.count == 0) return 0.0;
    const double rank = std::clamp(share, 0.0, 1.0) * static_cast<double>(h.count);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < h.bins; ++i) {
        below += h.counts[i];
        if (below > 0 && static_cast<double>(below) >= rank)
            return 1e-9 * static_cast<double>(std::min(end_of(i) - 1, h.greatest));
    }
    return 1e-9 * static_cast<double>(h.greatest);
}

// s; 0 if the histogram is empty.
inline double mean(const Histogram& h) {
    return h.count == 0 ? 0.0 : 1e-9 * h.sum / static_cast<double>(h.count);
}

// The share (0 … 1) of the values above `seconds`. Values in the same bin count as above.
inline double share_above(const Histogram& h, double seconds) {
    if (h.count == 0) return 0.0;
    const double ns = std::clamp(seconds * 1e9, 0.0, static_cast<double>(h.most));
    std::uint64_t above = 0;
    for (std::size_t i = bin_of(static_cast<std::uint64_t>(ns)); i < h.bins; ++i) above += h.counts[i];
    return static_cast<double>(above) / static_cast<double>(h.count);
}

}  // namespace bolt::servo
