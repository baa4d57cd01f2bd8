// Encodes consecutive ticks as bytes and decodes them.
//
// A chunk is a header (version u8, count u32, first tick u64, little-endian) and one zstd frame with a
// checksum. The frame stores the ticks by column. A value is stored as the difference of its bits from the
// previous value's (the first one from zero), zigzag-encoded, so that small steps up or down have high zero
// bits. Each column is split into byte planes, lowest bytes first. Version 1 ends with the clamp force,
// version 2 with the fault, version 3 with the undo; the columns that are missing get their defaults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "game/session/tick.hpp"

namespace bolt::session {

// One second at the shortest tick of a session; a larger count means damage.
inline constexpr std::size_t max_chunk_ticks = 100'000;

// Reuses its buffers: a chunk no longer than an earlier one allocates nothing.
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
