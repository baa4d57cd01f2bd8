// Sessions with changed bytes: reading never crashes, and never returns wrong data without an error.
#include <doctest/doctest.h>

#include "game/session/session_file.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

struct Contents {
    Header header;
    bool complete = false;
    std::vector<TickRecord> ticks;
    std::vector<lesson::LessonEvent> events;
    lesson::LessonResult result;
};

Contents contents_of(const std::filesystem::path& path) {
    const auto reader = SessionReader::open(path);
    REQUIRE(reader);
    auto events = reader->events();
    auto result = reader->result();
    REQUIRE(events);
    REQUIRE(result);
    return {reader->header(), reader->complete(), all_ticks(*reader), *events, *result};
}

// Reads everything; every part must be an error or equal to `right`. Returns true if all of it was read.
bool is_right_or_refused(const std::filesystem::path& path, const Contents& right) {
    const auto reader = SessionReader::open(path);
    if (!reader) {
        CHECK(reader.error().file == path.string());
        CHECK_FALSE(reader.error().what.empty());
        return false;
    }
    CHECK(same(reader->header(), right.header));
    CHECK(reader->complete() == right.complete);
    CHECK(reader->tick_count() == right.ticks.size());
    std::vector<TickRecord> ticks;
    const Status read = reader->for_each_chunk([&](std::uint64_t, std::span<const TickRecord> chunk) {
        ticks.insert(ticks.end(), chunk.begin(), chunk.end());
    });
    CHECK(ticks.size() <= right.ticks.size());
    CHECK(same(ticks, std::span(right.ticks).first(ticks.size())));  // also the ticks before the damage
    if (read) CHECK(ticks.size() == right.ticks.size());
    const auto events = reader->events();
    if (events) {
        CHECK(events->size() == right.events.size());
        for (std::size_t i = 0; i < std::min(events->size(), right.events.size()); ++i)
            CHECK(same((*events)[i], right.events[i]));
    }
    const auto result = reader->result();
    if (result) CHECK(same(*result, right.result));
    return read && events && result;
}

std::filesystem::path whole_session(const Folder& folder) {
    auto writer = create_script(folder / "whole.session");
    REQUIRE(writer);
    REQUIRE(play_script(*writer, 85));
    REQUIRE(writer->finish(sample_result()));
    return folder / "whole.session";
}

}  // namespace

TEST_CASE("Damage: flipped bits anywhere in a session are harmless or detected") {
    const Folder folder;
    const Contents right = contents_of(whole_session(folder));
    const std::string good = bytes_of(folder / "whole.session");
    Random random(99);
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        const std::size_t at = random.bits() % good.size();
        const auto mask = static_cast<char>(1U << random.bits() % 8);
        CAPTURE(at);
        CAPTURE(static_cast<int>(mask));
        std::string bytes = good;
        bytes[at] = static_cast<char>(bytes[at] ^ mask);
        put_bytes(folder / "a.session", bytes);
        if (!is_right_or_refused(folder / "a.session", right)) ++refused;
    }
    CHECK(refused > 500);  // flips in the unused parts of pages are harmless
}

TEST_CASE("Damage: runs of wrong bytes in a session are harmless or detected") {
    const Folder folder;
    const Contents right = contents_of(whole_session(folder));
    const std::string good = bytes_of(folder / "whole.session");
    Random random(100);
    for (int i = 0; i < 400; ++i) {
        const std::size_t at = random.bits() % good.size();
        const std::size_t length = std::min<std::size_t>(good.size() - at, 1U << random.bits() % 14);
        const bool zeros = random.chance(0.5);
        CAPTURE(at);
        CAPTURE(length);
        std::string bytes = good;
        for (std::size_t k = at; k < at + length; ++k)
            bytes[k] = zeros ? '\0' : static_cast<char>(random.bits());
        put_bytes(folder / "a.session", bytes);
        is_right_or_refused(folder / "a.session", right);
    }
}

TEST_CASE("Damage: a truncated session is refused") {
    const Folder folder;
    const Contents right = contents_of(whole_session(folder));
    const std::string good = bytes_of(folder / "whole.session");
    for (std::size_t length = 0; length < good.size(); length += 1 + length / 8) {
        CAPTURE(length);
        put_bytes(folder / "a.session", good.substr(0, length));
        CHECK_FALSE(is_right_or_refused(folder / "a.session", right));
    }
    put_bytes(folder / "a.session", good);
    CHECK(is_right_or_refused(folder / "a.session", right));
}

TEST_CASE("Damage: a damaged log gives an earlier state of the session, or an error") {
    const Folder folder;
    auto writer = create_script(folder / "live.session");
    REQUIRE(writer);
    REQUIRE(play_script(*writer, 85));
    const std::string main = bytes_of(folder / "live.session");
    const std::string log = bytes_of(folder / "live.session-wal");
    REQUIRE(log.size() > 10'000);
    Random random(101);
    std::size_t shortest = 80;
    for (int i = 0; i < 500; ++i) {
        const std::size_t at = random.bits() % log.size();
        CAPTURE(at);
        std::string bytes = log;
        if (random.chance(0.8))
            bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1U << random.bits() % 8));
        else
            bytes.resize(at);
        std::filesystem::remove(folder / "a.session-shm");
        put_bytes(folder / "a.session", main);
        put_bytes(folder / "a.session-wal", bytes);
        const auto reader = SessionReader::open(folder / "a.session");
        if (!reader) continue;
        CHECK_FALSE(reader->complete());
        CHECK(reader->tick_count() <= 80);
        const std::string mismatch = script_mismatch(*reader);
        CHECK_MESSAGE(mismatch.empty(), mismatch);
        shortest = std::min<std::size_t>(shortest, reader->tick_count());
    }
    CHECK(shortest < 80);
}
