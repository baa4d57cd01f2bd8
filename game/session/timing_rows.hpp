// Converts the timing of a servo thread to table rows and back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptics/servo/thread.hpp"

namespace bolt::session {

struct TimingRow {
    std::string name;  // "wake_up", "compute", "period": a histogram; "missed": only its count
    std::uint64_t count = 0;
    std::uint64_t least = 0, greatest = 0;  // ns
    double sum = 0.0;                       // ns
    std::vector<std::byte> bins;            // non-empty bins: index u32, count u64, little-endian
};

inline constexpr std::size_t timing_rows = 4;
std::array<TimingRow, timing_rows> rows_of(const servo::Timing& timing);

// Adds a row to `timing`. False if rows_of() cannot have made it.
bool take_row(servo::Timing& timing, const TimingRow& row);

}  // namespace bolt::session
