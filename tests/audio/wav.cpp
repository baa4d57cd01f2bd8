// WAV files: their contents are correct, and no incomplete file appears.

#include "engine/audio/wav.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <vector>

#include "engine/base/file.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::audio;
using test::Folder;

namespace {

std::uint32_t number(const std::string& bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value |=
            static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]))
            << (8 * i);
    return value;
}

std::int16_t sample(const std::string& bytes, std::size_t i) {
    return static_cast<std::int16_t>(number(bytes, 44 + 2 * i, 2));
}

std::string contents(const std::filesystem::path& path) {
    const auto bytes = read_file(path, 1U << 24U, ErrorCode::failed);
    REQUIRE(bytes);
    return *bytes;
}

}  // namespace

TEST_CASE("WavWriter: header and samples are correct for every block size") {
    const Folder folder;
    const auto path = folder / "a.wav";
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> samples{
        0.0F, 0.5F, -0.5F, 1.0F, -1.0F, 2.0F, -inf, std::numeric_limits<float>::quiet_NaN(), 1.0F / 32767.0F};
    auto wav = WavWriter::create(path, 48000);
    REQUIRE(wav);
    CHECK_FALSE(std::filesystem::exists(path));  // the file appears only after finish()
    REQUIRE(wav->write(std::span(samples).first(2)));
    REQUIRE(wav->write(std::span(samples).subspan(2, 0)));
    REQUIRE(wav->write(std::span(samples).subspan(2)));
    REQUIRE(wav->finish());
    const std::string bytes = contents(path);
    REQUIRE(bytes.size() == 44 + 2 * samples.size());
    CHECK(bytes.substr(0, 4) == "RIFF");
    CHECK(number(bytes, 4, 4) == bytes.size() - 8);
    CHECK(bytes.substr(8, 8) == "WAVEfmt ");
    CHECK(number(bytes, 20, 2) == 1);      // PCM
    CHECK(number(bytes, 22, 2) == 1);      // channels
    CHECK(number(bytes, 24, 4) == 48000);  // samples per second
    CHECK(number(bytes, 28, 4) == 96000);  // bytes per second
    CHECK(number(bytes, 32, 2) == 2);      // bytes per sample
    CHECK(number(bytes, 34, 2) == 16);     // bits
    CHECK(bytes.substr(36, 4) == "data");
    CHECK(number(bytes, 40, 4) == 2 * samples.size());
    const std::vector<int> expected{0, 16384, -16384, 32767, -32767, 32767, -32767, 0, 1};
    for (std::size_t i = 0; i < samples.size(); ++i) CHECK(sample(bytes, i) == expected[i]);
    CHECK_FALSE(std::filesystem::exists(folder / "a.wav.part"));
    const Status late = wav->write(samples);  // write() fails after finish()
    REQUIRE_FALSE(late);
    CHECK(late.error().what == "is already finished");
}

TEST_CASE("WavWriter: without finish() the previous file stays, and no other file remains") {
    const Folder folder;
    const auto path = folder / "a.wav";
    REQUIRE(write_file(path, "the one before"));
    {
        auto wav = WavWriter::create(path, 48000);
        REQUIRE(wav);
        REQUIRE(wav->write(std::vector<float>(100000, 0.1F)));
    }
    CHECK(contents(path) == "the one before");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("WavWriter: errors name the file and are repeated by later calls") {
    const Folder folder;
    const auto nowhere = WavWriter::create(folder.path() / "no" / "a.wav", 48000);
    REQUIRE_FALSE(nowhere);
    CHECK(nowhere.error().message().find("no/a.wav") != std::string::npos);
    auto full = WavWriter::create("/dev/full", 48000);
    REQUIRE(full);
    const Status written = full->write(std::vector<float>(100000, 0.1F));
    REQUIRE_FALSE(written);
    CHECK(written.error().message().find("/dev/full") != std::string::npos);
    CHECK_FALSE(full->write(std::vector<float>(1)));
    CHECK_FALSE(full->finish());
}

TEST_CASE("WavWriter: a pipe or device is written to directly and not replaced") {
    auto wav = WavWriter::create("/dev/null", 48000);
    REQUIRE(wav);
    REQUIRE(wav->write(std::vector<float>(1000)));
    REQUIRE(wav->finish());
    CHECK(std::filesystem::is_character_file("/dev/null"));
}
