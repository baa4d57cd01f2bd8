// Finds frames in the byte stream of a glove, which may lose, insert or change bytes.
//
// A frame is a letter ('S' when streaming, 'G' when polled), one byte 1 … 255 per sensor, five bytes of time
// and one of status if enabled, 'e' and a letter if the glove reports an error, and a zero. Without the time
// no other byte is zero, so incomplete frames are detected and the reader resynchronises at the next zero.
#pragma once

#include "engine/base/function_ref.hpp"
#include "haptics/hand/glove_sensors.hpp"

namespace bolt::hand {

struct GloveFrameLayout {
    std::size_t sensors = 18;  // 18 or 22
    bool time = false, status = false;
};

struct GloveFrame {
    PerSensor<std::uint8_t> raw{};  // 1 … 255; 0: the glove has no such sensor
    std::uint8_t status = 0;        // valid if the layout has it
    bool too_slow = false;          // "es": the sample rate exceeds the line's capacity
    bool unplugged = false;         // "eg": the glove is not connected to its interface unit
};

inline constexpr std::size_t longest_frame = 1 + sensor_count + 5 + 1 + 4 + 1;

struct GloveFrameReader {
    GloveFrameLayout layout;
    char letter = 'S';
    // The partial frame, and totals.
    std::array<std::uint8_t, longest_frame> bytes{};
    std::size_t count = 0;
    std::uint64_t frames = 0;
    std::uint64_t lost = 0;  // bytes outside valid frames
};

// Accepts bytes in blocks of any size and calls `on_frame` for each complete frame. Allocates nothing.
void read_frames(GloveFrameReader& reader, std::span<const std::uint8_t> bytes,
                 FunctionRef<void(const GloveFrame&)> on_frame);

}  // namespace bolt::hand
