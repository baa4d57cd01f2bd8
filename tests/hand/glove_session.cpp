#include "haptics/hand/glove_protocol.hpp"

#include <doctest/doctest.h>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

// A session with an emulated glove over a line, in virtual time.
struct SessionBench {
    explicit SessionBench(const emulate::EmulatedGloveOptions& design) : glove(design) {}

    emulate::EmulatedGlove glove;
    GloveSession session;
    double now = 0.0;
    int frames = 0;
    bool cut = false;  // the line carries no bytes

    void update(double seconds) {
        for (const double end = now + seconds; now < end; now += 1e-3) {
            const auto sent = session.update(from_glove_, now, [&](const GloveFrame&) { ++frames; });
            from_glove_ = glove.advance(to_glove_, now);
            to_glove_ = sent;
            if (cut) {
                from_glove_.clear();
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
    std::vector<std::uint8_t> from_glove_, to_glove_;
};

}  // namespace

TEST_CASE("GloveSession: a stalled glove is reported within 0.25 s and read again afterwards") {
    SessionBench bench({.sensors = 22});
    CHECK(bench.until(GloveState::streaming) < 0.5);
    bench.update(1.0);
    CHECK(bench.frames >= 78);
    bench.glove.stalled = true;
    CHECK(bench.until(GloveState::silent) < 0.27);
    CHECK(bench.session.fault_message().find("stopped sending") != std::string::npos);
    bench.update(7.0);
    CHECK(bench.session.state() != GloveState::streaming);
    bench.glove.stalled = false;
    CHECK(bench.until(GloveState::streaming) < 2.0);
    const int frames = bench.frames;
    bench.update(1.0);
    CHECK(bench.frames > frames + 75);
    CHECK(bench.session.handshakes() == 2);
    CHECK(bench.session.fault_message().empty());
}

TEST_CASE("GloveSession: a replug at any moment is read again within 2 s") {
    for (int trial = 0; trial < 30; ++trial) {
        SessionBench bench({.seed = static_cast<std::uint64_t>(trial)});
        bench.until(GloveState::streaming);
        bench.update(0.1 + 0.013 * trial);
        bench.cut = true;
        CHECK(bench.until(GloveState::silent) < 0.27);
        bench.update(0.4 * trial);
        bench.cut = false;
        CHECK(bench.until(GloveState::streaming) < 2.0);
    }
}

TEST_CASE("GloveSession: a glove disconnected from its interface unit yields no frames and a reason") {
    SessionBench bench({.plugged = false});
    bench.until(GloveState::streaming);
    bench.update(1.0);
    CHECK(bench.frames == 0);
    CHECK(!bench.session.identity().plugged);
    CHECK(bench.session.fault_message().find("not plugged") != std::string::npos);
}

TEST_CASE("GloveSession: for two hours on a bad line with stalls, frames keep arriving") {
    SessionBench bench({.sensors = 22, .faults = {0.002, 0.001, 0.002}});
    Random random(9);
    std::uint64_t frames = 0;
    for (int minute = 0; minute < 120; ++minute) {
        bench.update(random.uniform(0.0, 50.0));
        bench.glove.stalled = random.uniform(0.0, 1.0) < 0.5;
        bench.update(random.uniform(0.0, 8.0));
        bench.glove.stalled = false;
        bench.until(GloveState::streaming, 30.0);
        bench.update(2.0);
        CHECK(bench.session.frames() > frames);
        frames = bench.session.frames();
    }
    CHECK(frames > 100000);
}
