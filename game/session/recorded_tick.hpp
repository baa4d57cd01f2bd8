// Recorded ticks and their compressed chunks. A tick has the exact input, and the output in single precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::session {

struct TickRecord {
    servo::CommandedTool commanded_tool;
    std::uint8_t grip = 0;   // servo::Grip
    std::uint8_t flags = 0;  // see below
    std::int16_t guided_joint =
        -1;  // joint that the guiding force leads to, TickInput::guided_joint; −1: none
    float force[3] = {0.0F, 0.0F, 0.0F};   // N
    float torque[3] = {0.0F, 0.0F, 0.0F};  // N·m
    std::int16_t joint = -1;               // engaged joint, Output::joint; −1: none
    std::uint8_t stage = 0;                // joint::Stage
    float wrench_torque = 0.0F;            // N·m
    float nut_angle = 0.0F;                // rad
    float clamp = 0.0F;                    // N

    // Since format 2; sessions of format 1 have the defaults.
    std::uint16_t contacts = 0;     // of the wrench
    collision::ObstacleId touched;  // obstacle against the wrench; named in Header::obstacle_names
    std::uint8_t fault = 0;         // force::Fault of the output stage

    std::uint8_t checkpoint_action = 0;  // TickInput::checkpoint_action; since format 3
    float set_torque = 0.0F;             // N·m, TickInput::set_torque; since format 4
    std::uint8_t tool = 0;               // TickInput::tool; since format 7
    std::int16_t second_wrench = -1;     // TickInput::second_wrench; since format 8
};

// The number of an obstacle in a session file, in its ticks and in its table of names: none −1, fixed
// obstacles 0 to 999, nuts from 1000 on. A fixed obstacle with an index i ≥ 1000 has the number 998 − i
// (−2, −3, …), which no older file contains. Returns no value for a fixed obstacle with an index of max_fixed
// or more and for a nut with an index of max_nuts or more.
std::optional<std::int16_t> file_number(collision::ObstacleId obstacle);
collision::ObstacleId obstacle_of_number(std::int16_t number);

inline constexpr std::size_t max_fixed = 33766, max_nuts = 31768;

// Bits of `flags`: the dead-man switch is held; no new sample of the device arrived; the emergency stop is
// pressed; the reset that releases it is pressed. The upper four bits of `flags` count missed deadlines.
inline constexpr std::uint8_t flag_dead_man = 1, flag_no_sample = 2, flag_stop = 4, flag_reset = 8;

TickRecord make_record(const servo::TickInput& input, const servo::Output& output);
servo::TickInput input_of(const TickRecord& record);

// True if the outputs are equal bit by bit; NaNs with equal bits count as equal.
bool same_output(const TickRecord& a, const TickRecord& b);

// True if each enumeration has one of its values and no index is less than −1. Other records are neither
// written nor returned, so a reader may use a stage as an index without a check. The number of joints is not
// known here, so the index of a joint may be too large.
bool is_valid(const TickRecord& record);

// A chunk encodes consecutive ticks as bytes. It is a header (version u8, count u32, first tick u64,
// little-endian) and one zstd frame with a checksum. The frame stores the ticks by column. A value is stored
// as the difference of its bits from the previous value's (the first one from zero), zigzag-encoded, so that
// small steps up or down have leading zero bits. Each column is split into byte planes, lowest bytes first.
// Each version adds columns at the end: version 1 ends with the clamp force, 2 with the fault, 3 with the
// checkpoint action, 4 with the set torque, 5 with the tool, 6 with the second wrench. Version 6 is written.
// In an older chunk the missing columns have their defaults.

// The greatest number of ticks in a chunk: one second at the shortest tick, 10 µs. A larger count is damage.
inline constexpr std::size_t max_chunk_ticks = 100'000;

// Reuses its buffers, so a chunk no longer than an earlier one needs no allocation.
class ChunkEncoder {
  public:
    ChunkEncoder();
    ChunkEncoder(ChunkEncoder&& other) noexcept;
    ChunkEncoder& operator=(ChunkEncoder&& other) noexcept;
    ~ChunkEncoder();

    // `ticks` is no longer than max_chunk_ticks. The bytes stay valid until the next call.
    Result<std::span<const std::byte>> encode(std::uint64_t first_tick, std::span<const TickRecord> ticks);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

class ChunkDecoder {
  public:
    ChunkDecoder();
    ChunkDecoder(ChunkDecoder&& other) noexcept;
    ChunkDecoder& operator=(ChunkDecoder&& other) noexcept;
    ~ChunkDecoder();

    // Accepts any bytes; fails with the reason if they are not a chunk of `count` ticks from `first_tick`.
    // The ticks stay valid until the next call.
    Result<std::span<const TickRecord>> decode(std::uint64_t first_tick, std::size_t count,
                                               std::span<const std::byte> bytes);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bolt::session
