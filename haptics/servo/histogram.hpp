// How long things took: counts in bins that grow with the value, so that microseconds and stalls of seconds
// fit side by side. Fixed in size, no allocation; a copy is a value.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace bolt::servo {

// Below 32 ns a bin a nanosecond, from there on 16 bins an octave: a value is known to a sixteenth.
// (Log-linear bins as HdrHistogram has them.)
struct Histogram {
    static constexpr int fine = 4;                           // bits of a value that tell bins apart
    static constexpr std::uint64_t most = (1ULL << 40) - 1;  // ns, 18 minutes: what is longer counts as this
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

// First value that is in the bin after this one.
constexpr std::uint64_t end_of(std::size_t bin) {
    constexpr std::size_t linear = 2U << Histogram::fine;
    if (bin < linear) return bin + 1;
    const std::size_t octave = (bin >> Histogram::fine) - 1;
    return (static_cast<std::uint64_t>(bin - (octave << Histogram::fine)) + 1) << octave;
}

// A clock that went backwards counts as 0.
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

// Seconds that a share of all values (0 … 1) did not exceed: never understated, overstated by a sixteenth at
// most.
inline double quantile(const Histogram& h, double share) {
    if (h.count == 0) return 0.0;
    const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(h.count);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < h.bins; ++i) {
        below += h.counts[i];
        if (below > 0 && static_cast<double>(below) >= wanted)
            return 1e-9 * static_cast<double>(std::min(end_of(i) - 1, h.greatest));
    }
    return 1e-9 * static_cast<double>(h.greatest);
}

inline double mean(const Histogram& h) {
    return h.count == 0 ? 0.0 : 1e-9 * h.sum / static_cast<double>(h.count);
}

// Share of the values that were longer than `seconds`; those in its own bin count as longer.
inline double share_above(const Histogram& h, double seconds) {
    if (h.count == 0) return 0.0;
    const double ns = std::clamp(seconds * 1e9, 0.0, static_cast<double>(h.most));
    std::uint64_t above = 0;
    for (std::size_t i = bin_of(static_cast<std::uint64_t>(ns)); i < h.bins; ++i) above += h.counts[i];
    return static_cast<double>(above) / static_cast<double>(h.count);
}

}  // namespace bolt::servo
