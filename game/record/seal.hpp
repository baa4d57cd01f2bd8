// A seal says how many rows a table has and what they add up to. SQLite checks the shape of its pages but not
// what stands in them; with a seal a changed number, a lost row or an altered text is noticed.
//
// Sums do not depend on the order of the rows, so a changed row costs a subtraction and an addition. They
// guard against damage, not against forgery.
#pragma once

#include <cstdint>
#include <string_view>

#include "game/lesson/result.hpp"
#include "game/record/session.hpp"
#include "game/record/timing_rows.hpp"

namespace bolt::record {

struct Seal {
    std::uint64_t rows = 0;
    std::uint64_t sum = 0;

    void add(std::uint64_t row) { ++rows, sum += row; }
    void change(std::uint64_t before, std::uint64_t after) { sum += after - before; }
    bool operator==(const Seal&) const = default;
};

// What a row adds. NaNs are all alike and −0 is 0, because SQLite keeps neither apart.
std::uint64_t sum_of_meta(std::string_view key, std::string_view value);
std::uint64_t sum_of_chunk(std::uint64_t first_tick, std::uint64_t count);
std::uint64_t sum_of(const ObstacleName& obstacle);
std::uint64_t sum_of(const TimingRow& row);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::Event& event);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::JointResult& result);
std::uint64_t sum_of(std::uint64_t ordinal, const lesson::ScoreReason& reason);

}  // namespace bolt::record
