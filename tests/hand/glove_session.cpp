#include "haptics/hand/glove_protocol.hpp"

#include <doctest/doctest.h>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

// A session with an emulated glove over a line, in virtual time.
struct Talk {
    explicit Talk(const emulate::EmulatedGloveOptions& design) : glove(design) {}

    emulate::EmulatedGlove glove;
    GloveSession session;
    double now = 0.0;
    int frames = 0;
    bool cut = false;  // the line carries no bytes

    void update(double seconds) {
        for (const double end = now + seconds; now < end; now += 1e-3) {
            const auto said = session.update(to_us_, now, [&](const GloveFrame&) { ++frames; });
            to_us_ = glove.advance(to_glove_, now);
            to_glove_ = said;
            if (cut) {
                to_us_.clear();
                to_glove_.clear();
            }
        }
    }
    // Advances until the session has the state. Returns the time it took, s.
    double until(GloveState state, double most = 20.0) {
        const double from = now;
        while (session.state() != state && now - from < most) update(1e-3);
        return now - from;
    }

  private:
    std::vector<std::uint8_t> to_us_, to_glove_;
};

}  // namespace

TEST_CASE("GloveSession: a stalled glove is reported within 0.25 s and read again afterwards") {
    Talk talk({.sensors = 22});
    CHECK(talk.until(GloveState::streaming) < 0.5);
    talk.update(1.0);
    CHECK(talk.frames >= 78);
    talk.glove.stalled = true;
    CHECK(talk.until(GloveState::silent) < 0.27);
    CHECK(talk.session.trouble().find("stopped sending") != std::string::npos);
    talk.update(7.0);
    CHECK(talk.session.state() != GloveState::streaming);
    talk.glove.stalled = false;
    CHECK(talk.until(GloveState::streaming) < 2.0);
    const int frames = talk.frames;
    talk.update(1.0);
    CHECK(talk.frames > frames + 75);
    CHECK(talk.session.handshakes() == 2);
    CHECK(talk.session.trouble().empty());
}

TEST_CASE("GloveSession: a replug at any moment is read again within 2 s") {
    for (int trial = 0; trial < 30; ++trial) {
        Talk talk({.seed = static_cast<std::uint64_t>(trial)});
        talk.until(GloveState::streaming);
        talk.update(0.1 + 0.013 * trial);
        talk.cut = true;
        CHECK(talk.until(GloveState::silent) < 0.27);
        talk.update(0.4 * trial);
        talk.cut = false;
        CHECK(talk.until(GloveState::streaming) < 2.0);
    }
}

TEST_CASE("GloveSession: a glove disconnected from its interface unit yields no frames and a reason") {
    Talk talk({.plugged = false});
    talk.until(GloveState::streaming);
    talk.update(1.0);
    CHECK(talk.frames == 0);
    CHECK(!talk.session.identity().plugged);
    CHECK(talk.session.trouble().find("not plugged") != std::string::npos);
}

TEST_CASE("GloveSession: two hours on a bad line with stalls: never stuck, no growth") {
    Talk talk({.sensors = 22, .faults = {0.002, 0.001, 0.002}});
    Random random(9);
    std::uint64_t frames = 0;
    for (int minute = 0; minute < 120; ++minute) {
        talk.update(random.uniform(0.0, 50.0));
        talk.glove.stalled = random.uniform(0.0, 1.0) < 0.5;
        talk.update(random.uniform(0.0, 8.0));
        talk.glove.stalled = false;
        talk.until(GloveState::streaming, 30.0);
        talk.update(2.0);
        CHECK(talk.session.frames() > frames);
        frames = talk.session.frames();
    }
    CHECK(frames > 100000);
}
