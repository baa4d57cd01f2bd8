// Samples out of what a glove's line brings, which may lose, add or change bytes at any time.
//
// A frame is a letter ('S' of those that stream, 'G' of one that was asked for), a byte 1 … 255 a sensor,
// five bytes of time and one of status where these are on, 'e' and a letter where the glove has something to
// complain about, and a zero. Without the time no other byte is zero, so a frame that is not whole is told
// from one that is, and the next one found.
#pragma once

#include "engine/base/function_ref.hpp"
#include "haptics/glove/sensors.hpp"

namespace bolt::glove {

struct FrameLayout {
    std::size_t sensors = 18;  // 18 or 22
    bool time = false, status = false;
};

struct Frame {
    BySensor<std::uint8_t> raw{};  // 1 … 255; 0: a sensor that the glove has not
    std::uint8_t status = 0;       // where it is on
    bool too_slow = false;         // "es": the line cannot carry samples this often
    bool unplugged = false;        // "eg": the glove is not plugged into its box
};

inline constexpr std::size_t longest_frame = 1 + all_sensors + 5 + 1 + 4 + 1;

struct FrameReader {
    FrameLayout layout;
    char letter = 'S';
    // Of the frame that is being read; and what was seen so far.
    std::array<std::uint8_t, longest_frame> bytes{};
    std::size_t count = 0;
    std::uint64_t frames = 0;
    std::uint64_t lost = 0;  // bytes that belonged to no frame
};

// Takes the bytes in, however they are cut, and tells every whole frame as its zero comes. No allocation.
void read_frames(FrameReader& reader, std::span<const std::uint8_t> bytes,
                 FunctionRef<void(const Frame&)> tell);

}  // namespace bolt::glove
