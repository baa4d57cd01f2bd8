#include "haptics/hand/glove_protocol.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<GloveFrame> all(GloveFrameReader& reader, const Bytes& bytes) {
    std::vector<GloveFrame> frames;
    read_frames(reader, bytes, [&](const GloveFrame& f) { frames.push_back(f); });
    return frames;
}

Bytes frame_of(std::size_t sensors, std::uint8_t from = 1, const Bytes& tail = {0}) {
    Bytes bytes{'S'};
    for (std::size_t i = 0; i < sensors; ++i) bytes.push_back(static_cast<std::uint8_t>(from + i));
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    return bytes;
}

}  // namespace

TEST_CASE("GloveFrames: bytes map to the sensors of a glove with 18 or 22") {
    GloveFrameReader reader;
    auto frames = all(reader, frame_of(18, 10));
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].raw[index(Sensor::thumb_roll)] == 10);
    CHECK(frames[0].raw[index(Sensor::index_mpj)] == 14);
    CHECK(frames[0].raw[index(Sensor::index_pij)] == 15);
    CHECK(frames[0].raw[index(Sensor::index_dij)] == 0);
    CHECK(frames[0].raw[index(Sensor::middle_mpj)] == 16);
    CHECK(frames[0].raw[index(Sensor::wrist_yaw)] == 27);
    reader = {.layout = {22, false, false}};
    frames = all(reader, frame_of(22, 10));
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].raw[index(Sensor::index_dij)] == 16);
    CHECK(frames[0].raw[index(Sensor::wrist_yaw)] == 31);
}

TEST_CASE("GloveFrames: error codes, status and time are distinguished from the final zero") {
    GloveFrameReader reader;
    auto frames = all(reader, frame_of(18, 1, {'e', 's', 'e', 'g', 0}));
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].too_slow);
    CHECK(frames[0].unplugged);
    CHECK(all(reader, frame_of(18, 1, {'e', 's', 'e', 's', 0})).empty());
    CHECK(all(reader, frame_of(18, 1, {'e', 's', 'e', 'g', 'e', 's', 'e', 's', 0})).empty());
    reader = {.layout = {18, true, true}};
    frames = all(reader, frame_of(18, 1, {0, 0, 9, 0, 0, 6, 0}));
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].status == 6);
}

TEST_CASE("GloveFrames: any split of the bytes gives the same frames") {
    Bytes bytes;
    for (int i = 0; i < 40; ++i) {
        const Bytes one = frame_of(18, static_cast<std::uint8_t>(1 + 5 * i));
        bytes.insert(bytes.end(), one.begin(), one.end());
    }
    GloveFrameReader reader;
    CHECK(all(reader, bytes).size() == 40);
    Random random(3);
    for (int trial = 0; trial < 50; ++trial) {
        GloveFrameReader cut;
        std::size_t frames = 0;
        for (std::size_t at = 0; at < bytes.size();) {
            const std::size_t n = std::min<std::size_t>(1 + random.bits() % 50, bytes.size() - at);
            read_frames(cut, std::span(bytes).subspan(at, n), [&](const GloveFrame&) { ++frames; });
            at += n;
        }
        CHECK(frames == 40);
        CHECK(cut.lost == 0);
    }
}

TEST_CASE("GloveFrames: the reader resynchronises after garbage, and never merges two frames") {
    // Values equal to the frame's first letter are the hardest case for resynchronisation.
    const Bytes letters = [] {
        Bytes bytes{'S'};
        bytes.insert(bytes.end(), 18, 'S');
        bytes.push_back(0);
        return bytes;
    }();
    for (std::size_t cut = 1; cut < letters.size(); ++cut) {
        Bytes bytes(letters.begin() + static_cast<std::ptrdiff_t>(cut), letters.end());
        for (int i = 0; i < 3; ++i) bytes.insert(bytes.end(), letters.begin(), letters.end());
        GloveFrameReader reader;
        CHECK(all(reader, bytes).size() == 3);
        CHECK(reader.lost == letters.size() - cut);
    }
}

TEST_CASE(
    "GloveFrames: on a line that drops, changes and inserts bytes, frames are correct except for changed "
    "values") {
    for (const double rate : {0.001, 0.01, 0.05}) {
        emulate::EmulatedGloveOptions design;
        design.streaming = true;
        design.faults = {rate, 0.0, rate};
        emulate::EmulatedGlove glove(design);
        GloveFrameReader reader;
        std::uint64_t wrong = 0, frames = 0;
        for (int i = 0; i < 20000; ++i) {
            for (std::size_t s = 0; s < sensor_count; ++s)
                glove.raw[s] = static_cast<std::uint8_t>(40 + s * 7);
            const auto bytes = glove.advance({}, i * 0.005);
            read_frames(reader, bytes, [&](const GloveFrame& f) {
                ++frames;
                for (const Sensor s : sensors_of(18))
                    if (f.raw[index(s)] != 40 + index(s) * 7) {
                        ++wrong;
                        break;
                    }
            });
        }
        CAPTURE(rate);
        // A frame that loses one byte and gains another has the right length, which is undetectable.
        const double expected = static_cast<double>(glove.sent());
        CHECK(static_cast<double>(frames) > expected * std::pow(1.0 - 2.0 * rate, 21.0) * 0.97);
        CHECK(static_cast<double>(wrong) < 1.5 * expected * std::pow(20.0 * rate, 2.0) + 3.0);
    }
}
