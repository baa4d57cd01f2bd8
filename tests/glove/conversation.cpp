#include "haptics/glove/conversation.hpp"

#include <doctest/doctest.h>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::glove;

namespace {

// Conversation and glove over a line, in virtual time.
struct Talk {
    explicit Talk(const emulate::GloveDesign& design) : glove(design) {}

    emulate::Glove glove;
    Conversation conversation;
    double now = 0.0;
    int frames = 0;
    bool cut = false;  // the line carries nothing

    void go_on(double seconds) {
        for (const double end = now + seconds; now < end; now += 1e-3) {
            const auto said = conversation.go_on(to_us_, now, [&](const Frame&) { ++frames; });
            to_us_ = glove.go_on(to_glove_, now);
            to_glove_ = said;
            if (cut) {
                to_us_.clear();
                to_glove_.clear();
            }
        }
    }
    // Until it is so; the time that it took.
    double until(State state, double most = 20.0) {
        const double from = now;
        while (conversation.state() != state && now - from < most) go_on(1e-3);
        return now - from;
    }

  private:
    std::vector<std::uint8_t> to_us_, to_glove_;
};

}  // namespace

TEST_CASE("a glove that stalls is said to be silent within a quarter of a second, and read again after it") {
    Talk talk({.sensors = 22});
    CHECK(talk.until(State::streaming) < 0.5);
    talk.go_on(1.0);
    CHECK(talk.frames >= 78);
    talk.glove.stalled = true;
    CHECK(talk.until(State::silent) < 0.27);
    CHECK(talk.conversation.trouble().find("gives nothing") != std::string::npos);
    talk.go_on(7.0);
    CHECK(talk.conversation.state() != State::streaming);
    talk.glove.stalled = false;
    CHECK(talk.until(State::streaming) < 2.0);
    const int frames = talk.frames;
    talk.go_on(1.0);
    CHECK(talk.frames > frames + 75);
    CHECK(talk.conversation.greetings() == 2);
    CHECK(talk.conversation.trouble().empty());
}

TEST_CASE("a cable that is pulled and put back: read again within two seconds, whenever it was") {
    for (int trial = 0; trial < 30; ++trial) {
        Talk talk({.seed = static_cast<std::uint64_t>(trial)});
        talk.until(State::streaming);
        talk.go_on(0.1 + 0.013 * trial);
        talk.cut = true;
        CHECK(talk.until(State::silent) < 0.27);
        talk.go_on(0.4 * trial);
        talk.cut = false;
        CHECK(talk.until(State::streaming) < 2.0);
    }
}

TEST_CASE("out of its box the glove streams nothing worth telling, and says why") {
    Talk talk({.plugged = false});
    talk.until(State::streaming);
    talk.go_on(1.0);
    CHECK(talk.frames == 0);
    CHECK(!talk.conversation.identity().plugged);
    CHECK(talk.conversation.trouble().find("not plugged") != std::string::npos);
}

TEST_CASE("two hours over a bad line with stalls: never stuck, nothing grows") {
    Talk talk({.sensors = 22, .faults = {0.002, 0.001, 0.002}});
    Random random(9);
    std::uint64_t frames = 0;
    for (int minute = 0; minute < 120; ++minute) {
        talk.go_on(random.uniform(0.0, 50.0));
        talk.glove.stalled = random.uniform(0.0, 1.0) < 0.5;
        talk.go_on(random.uniform(0.0, 8.0));
        talk.glove.stalled = false;
        talk.until(State::streaming, 30.0);
        talk.go_on(2.0);
        CHECK(talk.conversation.frames() > frames);
        frames = talk.conversation.frames();
    }
    CHECK(frames > 100000);
}
