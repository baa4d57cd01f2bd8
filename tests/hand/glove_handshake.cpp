#include "haptics/hand/glove_protocol.hpp"

#include <doctest/doctest.h>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

// Runs the handshake with an emulated glove over a line with a delay of 2 ms. Returns the time it took, s.
double run_handshake(GloveHandshake& handshake, emulate::EmulatedGlove& glove, double most = 10.0) {
    std::vector<std::uint8_t> to_glove, from_glove;
    double now = 0.0;
    for (; now < most && !handshake.done() && !handshake.failed(); now += 2e-3) {
        const auto sent = handshake.update(from_glove, now);
        from_glove = glove.advance(to_glove, now);
        to_glove = sent;
    }
    from_glove = glove.advance(to_glove, now);
    return now;
}

}  // namespace

TEST_CASE("GloveHandshake: reads the identity and configures the stream") {
    for (const std::size_t sensors : {18U, 22U})
        for (const Side hand : {Side::left, Side::right})
            for (const bool busy : {false, true}) {
                emulate::EmulatedGlove glove(
                    {.sensors = sensors, .hand = hand, .status = busy, .time = busy, .streaming = busy});
                GloveHandshake handshake;
                const double took = run_handshake(handshake, glove);
                REQUIRE(handshake.done());
                CHECK(took < 0.5);
                CHECK(handshake.identity().sensors == sensors);
                CHECK(handshake.identity().side == hand);
                CHECK(handshake.identity().plugged);
                CHECK(handshake.identity().version == "1.2");
                CHECK(glove.streaming());
                GloveFrameReader reader{.layout = {sensors, false, false}};
                int frames = 0;
                for (double now = took; now < took + 1.0; now += 1e-3)
                    read_frames(reader, glove.advance({}, now), [&](const GloveFrame&) { ++frames; });
                CHECK(frames >= 79);
                CHECK(frames <= 81);
                CHECK(reader.lost == 0);
            }
}

TEST_CASE("GloveHandshake: sets the requested rate; a glove without that command keeps its own") {
    emulate::EmulatedGlove quick({}), old({.old_firmware = true});
    GloveHandshake fast({.rate = 120.0}), with_old({.rate = 120.0});
    run_handshake(fast, quick);
    run_handshake(with_old, old);
    REQUIRE(fast.done());
    REQUIRE(with_old.done());
    CHECK(quick.rate() == doctest::Approx(120.0));
    CHECK(old.rate() == 80.0);
    CHECK(with_old.identity().version.empty());
}

TEST_CASE("GloveHandshake: a glove disconnected from its interface unit is reported") {
    emulate::EmulatedGlove glove({.plugged = false});
    GloveHandshake handshake;
    run_handshake(handshake, glove);
    REQUIRE(handshake.done());
    CHECK(!handshake.identity().plugged);
}

TEST_CASE("GloveHandshake: on a bad line it succeeds or fails, never hangs, and accepts no wrong identity") {
    int done = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        emulate::EmulatedGlove glove(
            {.sensors = 22, .streaming = true, .faults = {0.02, 0.0, 0.02}, .seed = seed});
        GloveHandshake handshake;
        CHECK(run_handshake(handshake, glove, 30.0) < 29.0);
        if (!handshake.done()) continue;
        ++done;
        CHECK(handshake.identity().sensors == 22);
    }
    CHECK(done > 150);
}

TEST_CASE("GloveHandshake: a device that is not a glove is rejected") {
    SUBCASE("nothing answers") {
        emulate::EmulatedGlove dead({});
        dead.stalled = true;
        GloveHandshake handshake;
        CHECK(run_handshake(handshake, dead) < 2.0);
        REQUIRE(handshake.failed());
        CHECK(handshake.failed()->code == ErrorCode::no_device);
        CHECK(handshake.failed()->message().find("answers") != std::string::npos);
    }
    SUBCASE("a device that sends without end") {
        GloveHandshake handshake;
        const std::vector<std::uint8_t> chatter(3, 'x');
        double now = 0.0;
        for (; now < 10.0 && !handshake.failed(); now += 2e-3) handshake.update(chatter, now);
        REQUIRE(handshake.failed());
        CHECK(now < 4.0);
        CHECK(handshake.failed()->message().find("the port is never quiet;") != std::string::npos);
    }
    SUBCASE("a glove with an unknown number of sensors") {
        emulate::EmulatedGlove odd({.sensors = 5});
        GloveHandshake handshake;
        run_handshake(handshake, odd);
        REQUIRE(handshake.failed());
        CHECK(handshake.failed()->message().find("5 sensors") != std::string::npos);
    }
    SUBCASE("a device that answers every command with an error") {
        GloveHandshake handshake;
        const std::vector<std::uint8_t> error{'e', '?', '\r', '\n', 0};
        std::vector<std::uint8_t> answer;
        for (double now = 0.0; now < 5.0 && !handshake.failed(); now += 2e-3) {
            const auto sent = handshake.update(answer, now);
            answer = sent.empty() || sent.front() == 3 ? std::vector<std::uint8_t>{} : error;
        }
        REQUIRE(handshake.failed());
        CHECK(handshake.failed()->message().find("sensors") != std::string::npos);
    }
}
