#include "haptics/hand/glove_frames.hpp"

#include <algorithm>

namespace bolt::hand {

namespace {

enum class Verdict { whole, wanting, wrong };

// Classifies the bytes that follow a letter.
Verdict judge(const GloveFrameReader& reader, GloveFrame& frame) {
    const GloveFrameLayout& layout = reader.layout;
    const auto bytes = std::span(reader.bytes).first(reader.count);
    if (bytes.front() != static_cast<std::uint8_t>(reader.letter)) return Verdict::wrong;
    const auto sensors = sensors_of(layout.sensors);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        if (1 + i == bytes.size()) return Verdict::wanting;
        if (bytes[1 + i] == 0) return Verdict::wrong;
        frame.raw[index(sensors[i])] = bytes[1 + i];
    }
    std::size_t at = 1 + sensors.size() + (layout.time ? 5U : 0U);
    if (layout.status) {
        if (at >= bytes.size()) return Verdict::wanting;
        frame.status = bytes[at++];
    }
    for (; at < bytes.size(); at += 2) {
        if (bytes[at] == 0) return Verdict::whole;
        if (bytes[at] != 'e' || (frame.too_slow && frame.unplugged)) return Verdict::wrong;
        if (at + 1 == bytes.size()) return Verdict::wanting;
        bool& complaint = bytes[at + 1] == 's' ? frame.too_slow : frame.unplugged;
        if ((bytes[at + 1] != 's' && bytes[at + 1] != 'g') || complaint) return Verdict::wrong;
        complaint = true;
    }
    return Verdict::wanting;
}

// The letter did not start a frame; continue with the next one.
void give_up(GloveFrameReader& reader) {
    const auto end = reader.bytes.begin() + static_cast<std::ptrdiff_t>(reader.count);
    const auto next = std::find(reader.bytes.begin() + 1, end, static_cast<std::uint8_t>(reader.letter));
    reader.lost += static_cast<std::uint64_t>(next - reader.bytes.begin());
    reader.count =
        static_cast<std::size_t>(std::copy(next, end, reader.bytes.begin()) - reader.bytes.begin());
}

}  // namespace

void read_frames(GloveFrameReader& reader, std::span<const std::uint8_t> bytes,
                 FunctionRef<void(const GloveFrame&)> on_frame) {
    for (const std::uint8_t byte : bytes) {
        reader.bytes[reader.count++] = byte;
        while (reader.count > 0) {
            GloveFrame frame;
            const Verdict verdict = judge(reader, frame);
            if (verdict == Verdict::wanting) break;
            if (verdict == Verdict::wrong) {
                give_up(reader);
                continue;
            }
            ++reader.frames;
            reader.count = 0;
            on_frame(frame);
        }
    }
}

}  // namespace bolt::hand
