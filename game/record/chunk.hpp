// A run of ticks as bytes and back.
//
// A chunk is a header (version u8, count u32, first tick u64, little-endian) and one zstd frame with its
// checksum. Inside the frame the ticks stand column by column. A value is kept as the difference of its bits
// to those of the value before it (the first one to zero), with the sign moved to the lowest bit so that
// small steps either way have zeros on top; and a column is split into planes: all lowest bytes first, all
// highest bytes last. Version 1 ended with the clamp force, version 2 with the fault, version 3 with
// the undo; what came later has its default there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "game/record/tick.hpp"

namespace bolt::record {

// A second at the fastest tick that a session may have; more in one chunk is damage.
inline constexpr std::size_t max_chunk_ticks = 100'000;

// Keeps its buffers, so that a chunk no longer than one before it allocates nothing.
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

    // Any bytes may be given: what is no chunk of `count` ticks from `first_tick` on is an error that says
    // why. The ticks stay valid until the next call.
    Result<std::span<const TickRecord>> decode(std::uint64_t first_tick, std::size_t count,
                                               std::span<const std::byte> bytes);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bolt::record
