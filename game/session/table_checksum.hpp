// A checksum of a table: the number of its rows and the sum of their hashes. SQLite checks the structure of
// its pages but not their values; the checksum detects a changed number, a lost row or an altered text.
//
// The sum does not depend on the order of rows, so changing one costs a subtraction and an addition. It
// protects against damage, not against forgery.
#pragma once

#include <cstdint>
#include <string_view>

#include "game/lesson/result.hpp"
#include "game/session/session_file.hpp"
#include "game/session/timing_rows.hpp"

namespace bolt::session {

struct TableChecksum {
    std::uint64_t rows = 0;
    std::uint64_t sum = 0;

    void add(std::uint64_t row) { ++rows, sum += row; }
    void change(std::uint64_t before, std::uint64_t after) { sum += after - before; }
    bool operator==(const TableChecksum&) const = default;
};

// The hash of a row. All NaNs are equal and −0 equals 0, because SQLite does not distinguish them.
std::uint64_t sum_of_meta(std::string_view key, std::string_view value);
std::uint64_t sum_of_chunk(std::uint64_t first_tick, std::uint64_t count);
std::uint64_t sum_of(const ObstacleName& obstacle);
std::uint64_t sum_of(const TimingRow& row);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::Event& event);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::JointResult& result);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::ScoreReason& reason);

}  // namespace bolt::session
