// libFuzzer: any bytes are refused or decoded, and decoding an encoded chunk returns all bits of its ticks.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "game/session/recorded_tick.hpp"

using namespace bolt::session;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    ChunkDecoder decoder;
    // Use the count in the bytes, so that decoding continues after the header.
    std::uint32_t count = 0;
    if (size >= 5) std::memcpy(&count, data + 1, sizeof count);
    std::uint64_t first = 0;
    if (size >= 13) std::memcpy(&first, data + 5, sizeof first);
    if (const auto ticks = decoder.decode(first, count, bytes); ticks && ticks->size() != count) std::abort();

    // Interpret the same bytes as ticks.
    std::vector<TickRecord> ticks(size / sizeof(TickRecord));
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        TickRecord& tick = ticks[i];
        const std::uint8_t* from = data + i * sizeof(TickRecord);
        std::memcpy(&tick.commanded_tool, from, sizeof tick.commanded_tool);
        std::memcpy(&tick.force, from + 28, sizeof tick.force);
        std::memcpy(&tick.torque, from + 40, sizeof tick.torque);
        tick.grip = from[52] % 3;
        tick.flags = from[53];
        tick.stage = from[54] % bolt::joint::stage_count;
        tick.joint = static_cast<std::int16_t>(from[55] - 1);
        tick.touched = bolt::session::obstacle_of_number(static_cast<std::int16_t>(from[56] - 1));
        tick.fault = from[57] % bolt::force::fault_kinds;
    }
    ChunkEncoder encoder;
    const auto packed = encoder.encode(size, ticks);
    if (!packed) std::abort();
    std::vector<std::byte> good(packed->begin(), packed->end());
    const auto is_same = [&](std::span<const TickRecord> back) {
        // Compare bytes, because NaNs do not compare equal.
        const auto again = encoder.encode(size, back);
        return again && std::ranges::equal(*again, good);
    };
    const auto back = decoder.decode(size, ticks.size(), good);
    if (!back || !is_same(*back)) std::abort();

    // With one changed byte they are refused or still the same.
    if (size < 4) return 0;
    auto damaged = good;
    damaged[(data[0] + 256U * data[1]) % good.size()] ^= bytes[2];
    if (const auto read = decoder.decode(size, ticks.size(), damaged); read && !is_same(*read)) std::abort();
    return 0;
}
