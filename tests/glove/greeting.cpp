#include "haptics/glove/greeting.hpp"

#include <doctest/doctest.h>

#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::glove;

namespace {

// The two talk over a line that carries what one says to the other in the next 2 ms. The time it took, s.
double talk(Greeting& greeting, emulate::Glove& glove, double most = 10.0) {
    std::vector<std::uint8_t> to_glove, from_glove;
    double now = 0.0;
    for (; now < most && !greeting.done() && !greeting.failed(); now += 2e-3) {
        const auto said = greeting.go_on(from_glove, now);
        from_glove = glove.go_on(to_glove, now);
        to_glove = said;
    }
    from_glove = glove.go_on(to_glove, now);
    return now;
}

}  // namespace

TEST_CASE("a glove is asked what it is, and made to send what is read") {
    for (const std::size_t sensors : {18U, 22U})
        for (const Hand hand : {Hand::left, Hand::right})
            for (const bool busy : {false, true}) {
                emulate::Glove glove(
                    {.sensors = sensors, .hand = hand, .status = busy, .time = busy, .streaming = busy});
                Greeting greeting;
                const double took = talk(greeting, glove);
                REQUIRE(greeting.done());
                CHECK(took < 0.5);
                CHECK(greeting.identity().sensors == sensors);
                CHECK(greeting.identity().hand == hand);
                CHECK(greeting.identity().plugged);
                CHECK(greeting.identity().version == "1.2");
                CHECK(glove.streaming());
                FrameReader reader{.layout = {sensors, false, false}};
                int frames = 0;
                for (double now = took; now < took + 1.0; now += 1e-3)
                    read_frames(reader, glove.go_on({}, now), [&](const Frame&) { ++frames; });
                CHECK(frames >= 79);
                CHECK(frames <= 81);
                CHECK(reader.lost == 0);
            }
}

TEST_CASE("the rate is what was asked for; a glove that does not know about rates keeps its own") {
    emulate::Glove quick({}), old({.old_firmware = true});
    Greeting fast({.rate = 120.0}), with_old({.rate = 120.0});
    talk(fast, quick);
    talk(with_old, old);
    REQUIRE(fast.done());
    REQUIRE(with_old.done());
    CHECK(quick.rate() == doctest::Approx(120.0));
    CHECK(old.rate() == 80.0);
    CHECK(with_old.identity().version.empty());
}

TEST_CASE("a glove out of its box is greeted and said to be") {
    emulate::Glove glove({.plugged = false});
    Greeting greeting;
    talk(greeting, glove);
    REQUIRE(greeting.done());
    CHECK(!greeting.identity().plugged);
}

TEST_CASE("over a bad line the talk succeeds or fails, it does not hang, and no lie is believed") {
    int done = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        emulate::Glove glove({.sensors = 22, .streaming = true, .faults = {0.02, 0.0, 0.02}, .seed = seed});
        Greeting greeting;
        CHECK(talk(greeting, glove, 30.0) < 29.0);
        if (!greeting.done()) continue;
        ++done;
        CHECK(greeting.identity().sensors == 22);
    }
    CHECK(done > 150);
}

TEST_CASE("what is no glove is told from one") {
    SUBCASE("nothing answers") {
        emulate::Glove dead({});
        dead.stalled = true;
        Greeting greeting;
        CHECK(talk(greeting, dead) < 2.0);
        REQUIRE(greeting.failed());
        CHECK(greeting.failed()->code == ErrorCode::no_device);
        CHECK(greeting.failed()->message().find("answers") != std::string::npos);
    }
    SUBCASE("a line that never stops") {
        Greeting greeting;
        const std::vector<std::uint8_t> chatter(3, 'x');
        double now = 0.0;
        for (; now < 10.0 && !greeting.failed(); now += 2e-3) greeting.go_on(chatter, now);
        REQUIRE(greeting.failed());
        CHECK(now < 4.0);
        CHECK(greeting.failed()->message().find("quiet") != std::string::npos);
    }
    SUBCASE("a glove of a number of sensors that there is not") {
        emulate::Glove odd({.sensors = 5});
        Greeting greeting;
        talk(greeting, odd);
        REQUIRE(greeting.failed());
        CHECK(greeting.failed()->message().find("5 sensors") != std::string::npos);
    }
    SUBCASE("something that understands nothing") {
        Greeting greeting;
        const std::vector<std::uint8_t> error{'e', '?', '\r', '\n', 0};
        std::vector<std::uint8_t> answer;
        for (double now = 0.0; now < 5.0 && !greeting.failed(); now += 2e-3) {
            const auto said = greeting.go_on(answer, now);
            answer = said.empty() || said.front() == 3 ? std::vector<std::uint8_t>{} : error;
        }
        REQUIRE(greeting.failed());
        CHECK(greeting.failed()->message().find("sensors") != std::string::npos);
    }
}
