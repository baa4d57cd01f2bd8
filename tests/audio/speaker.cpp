// Tests of the speaker thread and OpenAL. Tests of OpenAL run in their own process, because OpenAL reads its
// driver selection once.

#include "engine/audio/speaker.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "engine/audio/sink.hpp"
#include "engine/base/file.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::audio;

#if defined(BOLT_SANITIZES_THREAD)
// OpenAL is built without the sanitizer, which therefore cannot see its thread synchronisation.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() { return "race:libopenal.so\n"; }
#endif

namespace {

struct ChildResult {
    int status = -1;     // exit status; 1000 + the wait status after a signal
    std::string errors;  // output to stderr
};

// Runs `work` in a child process with these OpenAL settings; its return value becomes the exit status.
template <class Work>
ChildResult in_child(const char* drivers, const char* config, const Work& work) {
    std::array<int, 2> pipe_ends{};
    REQUIRE(pipe(pipe_ends.data()) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        dup2(pipe_ends[1], STDERR_FILENO);
        close(pipe_ends[0]);
        close(pipe_ends[1]);
        setenv("ALSOFT_DRIVERS", drivers, 1);
        setenv("ALSOFT_CONF", config, 1);
        _exit(work());
    }
    close(pipe_ends[1]);
    ChildResult ended;
    std::array<char, 4096> bytes{};
    for (ssize_t n = 0; (n = read(pipe_ends[0], bytes.data(), bytes.size())) > 0;)
        ended.errors.append(bytes.data(), static_cast<std::size_t>(n));
    close(pipe_ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
    return ended;
}

FillSamples silence() {
    return [](std::span<float> samples) { std::fill(samples.begin(), samples.end(), 0.0F); };
}

}  // namespace

TEST_CASE("Speaker: the thread keeps a sink full and publishes its status") {
    // A simulated card that is unplugged on request.
    struct Card final : Sink {
        explicit Card(std::atomic<bool>& there) : plugged(there) {}
        [[nodiscard]] std::string name() const override { return "card"; }
        Result<std::size_t> free_blocks() override {
            if (!plugged) return fail(ErrorCode::no_device, "pulled out", {});
            return std::size_t{1};
        }
        Status play(std::span<const float, block_size>) override { return {}; }
        Status set_volume(double wished) override {
            volume = wished;
            return {};
        }
        std::atomic<bool>& plugged;
        double volume = 0.0;
    };
    std::atomic<bool> plugged = true;
    std::uint64_t filled = 0;
    {
        auto speaker = Speaker::start([&](std::span<float>) { ++filled; },
                                      [&]() -> Result<std::unique_ptr<Sink>> {
                                          if (!plugged) return fail(ErrorCode::no_device, "no card", {});
                                          return std::make_unique<Card>(plugged);
                                      });
        REQUIRE(speaker);
        CHECK(test::eventually([&] { return speaker->status().blocks > 20; }));
        CHECK(speaker->status_change() == "sound: card");
        CHECK_FALSE(speaker->status_change());
        speaker->set_volume(0.5);
        plugged = false;
        CHECK(test::eventually([&] { return speaker->status().losses == 1; }));
        CHECK(speaker->status_change() == "no sound: pulled out");
        CHECK(test::eventually([&] { return speaker->status().problem == "no card"; }));
        CHECK_FALSE(speaker->status_change());  // reported already
        plugged = true;
        CHECK(test::eventually([&] { return speaker->status().openings == 2; }));
        CHECK(speaker->status_change() == "sound: card");
    }
    CHECK(filled > 20);  // and no more samples are requested
}

TEST_CASE("Speaker: plays through OpenAL block after block and reports it once") {
    const ChildResult ended = in_child("null", "/dev/null", [] {
        auto speaker = Speaker::start(silence());
        if (!speaker) return 1;
        std::optional<std::string> news;
        if (!test::eventually([&] { return (news = speaker->status_change()).has_value(); })) return 2;
        if (news->rfind("sound: ", 0) != 0) return 3;
        if (!test::eventually([&] { return speaker->status().blocks > 3 * max_queued_blocks; })) return 4;
        speaker->set_volume(0.0);
        const std::uint64_t then = speaker->status().blocks;
        if (!test::eventually([&] { return speaker->status().blocks > then + max_queued_blocks; })) return 5;
        return speaker->status_change() ? 6 : 0;
    });
    CHECK(ended.status == 0);
}

TEST_CASE("Speaker: the output contains the samples that were filled in") {
    const test::Folder folder;
    const auto heard = folder / "heard.wav", config = folder / "alsoft.conf";
    REQUIRE(write_file(config,
                       "[general]\nfrequency=48000\nchannels=mono\nsample-type=int16\ndither=false\n"
                       "output-limiter=false\n[wave]\nfile=" +
                           heard.string() + "\n"));
    const ChildResult ended = in_child("wave", config.c_str(), [] {
        // A staircase: every block has its own level.
        int blocks = 0;
        auto speaker = Speaker::start([&](std::span<float> samples) {
            std::fill(samples.begin(), samples.end(), 0.01F * static_cast<float>(1 + blocks++ % 50));
        });
        if (!speaker) return 1;
        return test::eventually([&] { return speaker->status().blocks > 60; }) ? 0 : 2;
    });
    CHECK(ended.status == 0);
    const auto bytes = read_file(heard, 1U << 26U, ErrorCode::failed);
    std::filesystem::remove(heard);
    std::filesystem::remove(config);
    REQUIRE(bytes);
    // Every step has its full length; a busy machine may insert gaps of silence.
    std::vector<int> lengths(51, 0);
    for (std::size_t i = 60; i + 1 < bytes->size(); i += 2) {
        const auto value = static_cast<std::int16_t>(static_cast<unsigned char>((*bytes)[i]) |
                                                     static_cast<unsigned char>((*bytes)[i + 1]) << 8U);
        for (int stair = 1; stair <= 50; ++stair)
            if (std::abs(value - to_pcm16(0.01F * static_cast<float>(stair))) <= 1)
                ++lengths[static_cast<std::size_t>(stair)];
    }
    for (int stair = 2; stair <= 40; ++stair) {
        CAPTURE(stair);
        CHECK(lengths[static_cast<std::size_t>(stair)] >= static_cast<int>(block_size) - 1);
    }
}

TEST_CASE("Speaker: without a device the reason is reported once, without output of libraries") {
    for (const char* drivers : {"none", "alsa"}) {
        CAPTURE(drivers);
        const ChildResult ended = in_child(drivers, "/dev/null", [] {
            setenv("ALSA_CONFIG_PATH", "/dev/null", 1);  // ALSA finds no device on any machine
            auto speaker = Speaker::start([](std::span<float>) { _exit(9); });  // no samples are requested
            if (!speaker) return 1;
            std::optional<std::string> news;
            if (!test::eventually([&] { return (news = speaker->status_change()).has_value(); })) return 2;
            if (news->rfind("no sound: ", 0) != 0) return 3;
            return speaker->status_change() ? 4 : 0;
        });
        CHECK(ended.status == 0);
        CHECK(ended.errors.find("ALSA lib") == std::string::npos);
    }
}

TEST_CASE("Speaker: stops while its device plays, and continues after a move") {
    const ChildResult ended = in_child("null", "/dev/null", [] {
        for (int i = 0; i < 5; ++i)
            if (!Speaker::start(silence())) return 1;
        auto first = Speaker::start(silence());
        auto second = Speaker::start(silence());  // each with its own context
        if (!first || !second) return 2;
        *first = std::move(*second);
        return test::eventually([&] { return first->status().blocks > 2 * max_queued_blocks; }) ? 0 : 3;
    });
    CHECK(ended.status == 0);
}
