// The serial protocol of a glove: the session handles any bytes, split anywhere, without a crash, and returns
// only valid frames.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "haptics/hand/glove_protocol.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt::hand;
    GloveSession session;
    std::span<const std::uint8_t> left(data, size);
    double now = 0.0;
    while (!left.empty()) {
        // The first byte of each piece gives its length and its delay after the previous piece.
        const std::size_t n = std::min<std::size_t>(1 + left[0] % 24, left.size());
        now += (left[0] & 0x80) != 0 ? 0.1 : 0.002;
        const auto cut = left.subspan(1, n - 1);
        left = left.subspan(n);
        session.update(cut, now, [&](const GloveFrame& frame) {
            for (const Sensor s : sensors_of(session.identity().sensors))
                if (frame.raw[index(s)] == 0) std::abort();
        });
    }

    GloveFrameReader reader{.layout = {22, size % 2 == 1, size % 3 == 1}};
    read_frames(reader, {data, size}, [&](const GloveFrame& frame) {
        for (const std::uint8_t raw : frame.raw)
            if (raw == 0) std::abort();
    });
    if (reader.lost + reader.frames > size) std::abort();
    return 0;
}
