// How a servo thread kept its time, as rows of a table and back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptics/servo/timing.hpp"

namespace bolt::record {

struct TimingRow {
    std::string name;  // "wake_up", "compute", "period": a histogram; "missed": only its count
    std::uint64_t count = 0;
    std::uint64_t least = 0, greatest = 0;  // ns
    double sum = 0.0;                       // ns
    std::vector<std::byte> bins;  // of those that are not empty: index u32, count u64, little-endian
};

inline constexpr std::size_t timing_rows = 4;
std::array<TimingRow, timing_rows> rows_of(const servo::Timing& timing);

// Adds a row to the timing that it is of. False: it is no row that rows_of() makes.
bool take_row(servo::Timing& timing, const TimingRow& row);

}  // namespace bolt::record
