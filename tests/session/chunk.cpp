#include "game/session/recorded_tick.hpp"

#include <doctest/doctest.h>

#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

std::vector<std::byte> packed(std::uint64_t first, std::span<const TickRecord> ticks) {
    ChunkEncoder encoder;
    const auto bytes = encoder.encode(first, ticks);
    REQUIRE(bytes);
    return {bytes->begin(), bytes->end()};
}

}  // namespace

TEST_CASE("Chunk: decoding returns every bit of the ticks") {
    ChunkEncoder encoder;
    ChunkDecoder decoder;
    for (const std::size_t count : {1U, 2U, 3U, 999U, 1000U, 1001U, 4000U, 7U}) {
        CAPTURE(count);
        const std::vector<TickRecord> ticks = random_ticks(count, count);
        const auto bytes = encoder.encode(12345678901ULL, ticks);
        REQUIRE(bytes);
        const auto read = decoder.decode(12345678901ULL, count, *bytes);
        REQUIRE(read);
        CHECK(same(*read, ticks));
    }
}

TEST_CASE("Chunk: an empty chunk is valid") {
    ChunkDecoder decoder;
    const auto read = decoder.decode(0, 0, packed(0, {}));
    REQUIRE(read);
    CHECK(read->empty());
}

TEST_CASE("Chunk: the bytes are the same on every machine") {
    TickRecord tick;
    tick.commanded_tool.position[0] = 1.0F;  // 0x3F800000
    const std::vector<std::byte> bytes = packed(0x0102, {&tick, 1});
    const std::vector<std::byte> header(bytes.begin(), bytes.begin() + 13);
    const int expected[] = {6, 1, 0, 0, 0, 0x02, 0x01, 0, 0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < header.size(); ++i) CHECK(header[i] == static_cast<std::byte>(expected[i]));
    // zstd's magic number, and the checksum bit in the frame header's descriptor.
    CHECK(bytes[13] == std::byte{0x28});
    CHECK((bytes[17] & std::byte{4}) == std::byte{4});
}

TEST_CASE("Chunk: constant ticks need almost no space") {
    const std::vector<TickRecord> still(1000, random_ticks(1, 7).front());
    CHECK(packed(0, still).size() < 500);
}

TEST_CASE("Chunk: the error for a damaged chunk names the defect") {
    const std::vector<TickRecord> ticks = random_ticks(50, 3);
    const std::vector<std::byte> good = packed(100, ticks);
    ChunkDecoder decoder;
    const auto message = [&](std::uint64_t first, std::size_t count, std::span<const std::byte> bytes) {
        const auto read = decoder.decode(first, count, bytes);
        REQUIRE_FALSE(read);
        CHECK(read.error().what.find("the ticks from " + std::to_string(first)) == 0);
        return read.error().what;
    };
    CHECK(message(100, 50, {}).find("cut short") != std::string::npos);
    CHECK(message(100, 49, good).find("count") != std::string::npos);
    CHECK(message(101, 50, good).find("first tick is wrong") != std::string::npos);
    CHECK(message(100, 50, std::span(good).first(good.size() - 1)).find("damaged") != std::string::npos);
    auto version = good;
    version[0] = std::byte{9};
    CHECK(message(100, 50, version).find("version 9") != std::string::npos);
    auto longer = good;
    longer.push_back(std::byte{0});
    CHECK(message(100, 50, longer).find("damaged") != std::string::npos);
}

TEST_CASE("Chunk: a flipped bit is detected or has no effect") {
    const std::vector<TickRecord> ticks = random_ticks(20, 5);
    const std::vector<std::byte> good = packed(40, ticks);
    ChunkDecoder decoder;
    std::size_t noticed = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            auto bytes = good;
            bytes[i] ^= static_cast<std::byte>(1U << bit);
            const auto read = decoder.decode(40, 20, bytes);
            if (!read)
                ++noticed;
            else
                CHECK(same(*read, ticks));  // bits that zstd ignores
        }
    }
    CHECK(noticed > good.size() * 8 - 8);
}

TEST_CASE("Chunk: values outside their enumeration are refused") {
    std::vector<TickRecord> ticks = random_ticks(3, 9);
    SUBCASE("grip") { ticks[1].grip = 3; }
    SUBCASE("stage") { ticks[1].stage = 4; }
    SUBCASE("joint") { ticks[1].joint = -2; }
    SUBCASE("guide") { ticks[1].guided_joint = -2; }
    SUBCASE("touched") { ticks[1].touched = collision::ObstacleId::fixed(max_fixed); }
    SUBCASE("fault") { ticks[1].fault = force::fault_kinds; }
    ChunkDecoder decoder;
    const auto read = decoder.decode(0, 3, packed(0, ticks));
    REQUIRE_FALSE(read);
    CHECK(read.error().what.find("out of range") != std::string::npos);
}
