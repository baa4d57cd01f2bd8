// Metadata of sessions, and sessions of older formats.
#include <doctest/doctest.h>

#include <bit>
#include <limits>

#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"
#include "haptics/servo/servo_thread.hpp"
#include "tests/session/support.hpp"
#include "tests/support/oracle.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

TEST_CASE("Session format: a session of format 1 opens with all its data") {
    const auto reader = SessionReader::open(bolt::test::test_file("data/format-1.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().assembly == "cover-m8");
    CHECK(reader->header().trainee_profile == "novice");
    CHECK_FALSE(reader->header().contact_models.has_value());  // format 1 does not store them
    CHECK_FALSE(reader->header().device_limits);
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

TEST_CASE("Session format: a session of format 2 opens, without undo") {
    const auto reader = SessionReader::open(bolt::test::test_file("data/format-2.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().contact_models == "");
    CHECK(reader->header().device_limits);
    const std::vector<TickRecord> ticks = all_ticks(*reader);
    CHECK(ticks.size() > 10'000);
    bool held = false;
    for (const TickRecord& tick : ticks) {
        CHECK(tick.checkpoint_action == 0);
        held = held || (tick.joint == 0 && tick.wrench_torque > 15.0F);
    }
    CHECK(held);
}

TEST_CASE("Session format: a session of format 3 opens, with a set torque of 0") {
    const auto reader = SessionReader::open(bolt::test::test_file("data/format-3.boltwright"));
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    CHECK(reader->complete());
    CHECK(reader->header().tool.empty());
    CHECK_FALSE(reader->header().hand);

    const std::vector<TickRecord> ticks = all_ticks(*reader);
    CHECK(ticks.size() > 10'000);
    bool held = false, marked = false;
    for (const TickRecord& tick : ticks) {
        CHECK(tick.set_torque == 0.0F);
        held = held || (tick.joint == 0 && tick.wrench_torque > 15.0F);
        marked = marked || tick.checkpoint_action == servo::save_checkpoint;
    }
    CHECK(held);
    CHECK(marked);
}

TEST_CASE("Session format: parsing the text of device limits returns all bits") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        force::OutputLimits limits;
        limits.force = random.uniform(0.0, 40.0);
        limits.torque = i % 3 == 0 ? 0.0 : random.uniform(0.0, 3.0);
        limits.stiffness = std::exp(random.uniform(-300.0, 300.0));
        limits.delay = i % 4;
        limits.recovery_time = random.uniform();
        const auto read = parse_limits(limits_text(limits));
        REQUIRE(read);
        CHECK(limits_text(*read) == limits_text(limits));
        CHECK(read->force == limits.force);
        CHECK(read->stiffness == limits.stiffness);
        CHECK(read->delay == limits.delay);
        CHECK(read->recovery_time == limits.recovery_time);
    }
    const std::string good = limits_text({});
    CHECK_FALSE(parse_limits(""));
    CHECK_FALSE(parse_limits(good + " more=1"));
    CHECK_FALSE(parse_limits(good.substr(0, good.size() - 4)));
    CHECK_FALSE(parse_limits("force_N=twenty" + good.substr(good.find(' '))));
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
    return a.counts == b.counts && a.count == b.count && a.min == b.min && a.max == b.max && a.sum == b.sum;
}

}  // namespace

TEST_CASE("Session format: the session stores the latest timing of the servo thread") {
    const Folder folder;
    auto writer = SessionWriter::create(folder / "a.session", sample_header(0.1));
    REQUIRE(writer);
    REQUIRE(writer->record_timing(servo::Timing{}));
    for (const TickRecord& tick : random_ticks(25, 1)) REQUIRE(writer->append(tick));
    const servo::Timing timing = some_timing();
    REQUIRE(writer->record_timing(timing));
    REQUIRE(writer->finish({}));
    const auto reader = SessionReader::open(folder / "a.session");
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

TEST_CASE("Session format: a timing row that is not a histogram is refused") {
    const auto rows = rows_of(some_timing());
    for (const TimingRow& row : rows) {
        servo::Timing timing;
        CHECK(read_row(timing, row));
    }
    servo::Timing timing;
    TimingRow wrong = rows[0];
    SUBCASE("another name") { wrong.name = "waking"; }
    SUBCASE("a count that differs from the sum of the bins") { ++wrong.count; }
    SUBCASE("half an entry") { wrong.bins.pop_back(); }
    SUBCASE("an invalid bin index") { wrong.bins[3] = std::byte{0xFF}; }
    SUBCASE("bins whose sum overflows") {
        wrong.bins.resize(24);
        for (std::size_t i = 4; i < 12; ++i) wrong.bins[i] = std::byte{0xFF};
    }
    CHECK_FALSE(read_row(timing, wrong));
}

TEST_CASE("Session header: its texts round-trip, and an invalid text is an error that names the valid ones") {
    const Header header = sample_header(0.001);
    const auto same_header = header_of(texts_of(header), "a.session");
    REQUIRE(same_header);
    CHECK(texts_of(*same_header) == texts_of(header));
    struct Case {
        const char *key, *text, *message;
    };
    for (const Case& c :
         {Case{key::law, "elastic", "its law is \"elastic\"; expected published or mechanistic"},
          Case{key::mode, "", "its mode is \"\"; expected guided, practice or assessment"},
          Case{key::servo, "fast", "its servo is \"fast\"; expected virtual time, or a rate in Hz"},
          Case{key::hand, "both", "its hand is \"both\"; expected left or right"},
          Case{key::dt, "0", "its dt_s is \"0\"; expected a tick in s"}}) {
        CAPTURE(c.key);
        HeaderTexts texts = texts_of(header);
        texts[c.key] = c.text;
        const auto refused = header_of(texts, "a.session");
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message().find(c.message) != std::string::npos);
    }
    HeaderTexts texts = texts_of(header);
    texts.erase(key::task);
    CHECK(header_of(texts, "a.session").error().what == "is damaged: its task is missing");
}
