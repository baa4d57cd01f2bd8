// What a session says of how it was made, and sessions of older programs.
#include <doctest/doctest.h>

#include <bit>
#include <limits>

#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"
#include "haptics/servo/thread.hpp"
#include "tests/session/support.hpp"
#include "tests/support/oracle.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

TEST_CASE(
    "Session format: a session of format 1, recorded by an older program, opens with all that it holds") {
    const auto reader = Reader::open(bolt::test::test_file("data/format-1.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().assembly == "cover-m8");
    CHECK(reader->header().operator_name == "novice");
    CHECK(reader->header().obstacles.empty());  // it did not say
    CHECK(reader->header().device.empty());
    CHECK(reader->header().obstacle_names.empty());
    const std::vector<TickRecord> ticks = all_ticks(*reader);
    REQUIRE(ticks.size() == reader->tick_count());
    CHECK(ticks.size() > 5000);
    bool spun = false;
    for (const TickRecord& tick : ticks) {
        CHECK((tick.contacts == 0 && tick.touched.is_none() && tick.fault == 0));
        spun = spun || (tick.joint == 0 && tick.nut_angle > 1.0F);
    }
    CHECK(spun);
    const auto timing = reader->timing();
    REQUIRE(timing);
    CHECK_FALSE(timing->has_value());
    CHECK(reader->events()->size() > 2);
}

TEST_CASE("Session format: a session of format 2 too, and nothing was undone in it") {
    const auto reader = Reader::open(bolt::test::test_file("data/format-2.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().obstacles == "none");
    CHECK_FALSE(reader->header().device.empty());
    const std::vector<TickRecord> ticks = all_ticks(*reader);
    CHECK(ticks.size() > 10'000);
    bool held = false;
    for (const TickRecord& tick : ticks) {
        CHECK(tick.undo == 0);
        held = held || (tick.joint == 0 && tick.wrench_torque > 15.0F);
    }
    CHECK(held);
}

TEST_CASE("Session format: a session of format 3 too, and its wrench was set to nothing") {
    const auto reader = Reader::open(bolt::test::test_file("data/format-3.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().tool.empty());
    CHECK(reader->header().hand.empty());

    const std::vector<TickRecord> ticks = all_ticks(*reader);
    CHECK(ticks.size() > 10'000);
    bool held = false, marked = false;
    for (const TickRecord& tick : ticks) {
        CHECK(tick.setting == 0.0F);
        held = held || (tick.joint == 0 && tick.wrench_torque > 15.0F);
        marked = marked || tick.undo == servo::save_checkpoint;
    }
    CHECK(held);
    CHECK(marked);
}

TEST_CASE("Session format: a device's limits come back from their text to the last bit") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        force::OutputLimits limits;
        limits.force = random.uniform(0.0, 40.0);
        limits.torque = i % 3 == 0 ? 0.0 : random.uniform(0.0, 3.0);
        limits.stiffness = std::exp(random.uniform(-300.0, 300.0));
        limits.delay = i % 4;
        limits.recovery = random.uniform();
        const auto read = limits_of(text_of(limits));
        REQUIRE(read);
        CHECK(text_of(*read) == text_of(limits));
        CHECK(read->force == limits.force);
        CHECK(read->stiffness == limits.stiffness);
        CHECK(read->delay == limits.delay);
        CHECK(read->recovery == limits.recovery);
    }
    const std::string good = text_of({});
    CHECK_FALSE(limits_of(""));
    CHECK_FALSE(limits_of(good + " more=1"));
    CHECK_FALSE(limits_of(good.substr(0, good.size() - 4)));
    CHECK_FALSE(limits_of("force_N=twenty" + good.substr(good.find(' '))));
}

namespace {

servo::Timing some_timing() {
    servo::Timing timing;
    Random random(8);
    for (int i = 0; i < 5000; ++i) {
        const auto ns = [&] { return static_cast<std::int64_t>(std::exp(random.uniform(0.0, 20.0))); };
        servo::add(timing.wake_up, ns());
        servo::add(timing.compute, ns());
        if (i > 0) servo::add(timing.period, ns());
        ++timing.ticks;
    }
    timing.missed = 12;
    return timing;
}

bool same(const servo::Histogram& a, const servo::Histogram& b) {
    return a.counts == b.counts && a.count == b.count && a.least == b.least && a.greatest == b.greatest &&
           a.sum == b.sum;
}

}  // namespace

TEST_CASE("Session format: how a servo thread kept its time is in the session, as last told") {
    const Folder folder;
    auto writer = Writer::create(folder / "a.session", sample_header(0.1));
    REQUIRE(writer);
    REQUIRE(writer->keep(servo::Timing{}));
    for (const TickRecord& tick : random_ticks(25, 1)) REQUIRE(writer->append(tick));
    const servo::Timing timing = some_timing();
    REQUIRE(writer->keep(timing));
    REQUIRE(writer->finish({}));
    const auto reader = Reader::open(folder / "a.session");
    REQUIRE(reader);
    const auto read = reader->timing();
    REQUIRE_MESSAGE(read, (read ? "" : read.error().message()));
    REQUIRE(read->has_value());
    CHECK(same((*read)->wake_up, timing.wake_up));
    CHECK(same((*read)->compute, timing.compute));
    CHECK(same((*read)->period, timing.period));
    CHECK((*read)->ticks == 5000);
    CHECK((*read)->missed == 12);
    CHECK(same(reader->header(), sample_header(0.1)));
}

TEST_CASE("Session format: a row that is no histogram is not taken for one") {
    const auto rows = rows_of(some_timing());
    for (const TimingRow& row : rows) {
        servo::Timing timing;
        CHECK(take_row(timing, row));
    }
    servo::Timing timing;
    TimingRow wrong = rows[0];
    SUBCASE("another name") { wrong.name = "waking"; }
    SUBCASE("a count that is not the bins' sum") { ++wrong.count; }
    SUBCASE("half an entry") { wrong.bins.pop_back(); }
    SUBCASE("a bin that there is not") { wrong.bins[3] = std::byte{0xFF}; }
    SUBCASE("bins that add up round the corner") {
        wrong.bins.resize(24);
        for (std::size_t i = 4; i < 12; ++i) wrong.bins[i] = std::byte{0xFF};
    }
    CHECK_FALSE(take_row(timing, wrong));
}
