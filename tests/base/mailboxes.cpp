// The mailboxes between the servo and everything else. With real threads; what passes or fails does not
// depend on their speed. Run under ThreadSanitizer, which sees a missing release or acquire: BOLT_TEST=tsan
// ./test -R base
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/base/random.hpp"
#include "engine/base/spsc_ring.hpp"
#include "engine/base/triple_buffer.hpp"

using namespace bolt;

namespace {

// Large enough that it cannot be copied at once, and whole or not: every word is made from the first.
struct Message {
    std::array<std::uint64_t, 40> words{};
};

Message message(std::uint64_t n) {
    Message m;
    for (std::size_t i = 0; i < m.words.size(); ++i) m.words[i] = n * (2 * i + 1);
    return m;
}

bool whole(const Message& m) { return m.words == message(m.words[0]).words; }

}  // namespace

TEST_CASE("triple buffer: nothing new at first, then the latest, once") {
    TripleBuffer<int> box(7);
    CHECK_FALSE(box.update());
    CHECK(box.latest() == 7);
    box.write(1);
    CHECK(box.latest() == 7);  // what the reader holds changes only when it asks
    CHECK(box.update());
    CHECK(box.latest() == 1);
    CHECK_FALSE(box.update());
    for (int i = 2; i <= 10; ++i) box.write(i);
    CHECK(box.update());
    CHECK(box.latest() == 10);
    CHECK_FALSE(box.update());
    CHECK(box.latest() == 10);
}

TEST_CASE("triple buffer: a slot being filled is not seen before it is published") {
    TripleBuffer<int> box(0);
    box.slot() = 5;
    CHECK_FALSE(box.update());
    CHECK(box.latest() == 0);
    box.publish();
    CHECK(box.update());
    CHECK(box.latest() == 5);
}

TEST_CASE("triple buffer: any order of looks and writes gives the last one written before the look") {
    Random random(1);
    TripleBuffer<int> box(0);
    int written = 0, seen = 0;
    for (int i = 0; i < 100'000; ++i) {
        if (random.chance(0.5)) {
            box.write(++written);
        } else {
            REQUIRE(box.update() == (written != seen));
            seen = written;
            REQUIRE(box.latest() == seen);
        }
    }
}

TEST_CASE("triple buffer: a reader on another thread sees whole values, never an older one after a newer") {
    constexpr std::uint64_t last = 20'000;
    TripleBuffer<Message> box(message(0));
    std::thread writer([&box] {
        for (std::uint64_t n = 1; n <= last; ++n) box.write(message(n));
    });
    std::uint64_t seen = 0, torn = 0, back = 0;
    while (seen < last) {
        if (!box.update()) {
            std::this_thread::yield();
            continue;
        }
        const Message& m = box.latest();
        torn += whole(m) ? 0U : 1U;
        back += m.words[0] > seen ? 0U : 1U;
        seen = m.words[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(back == 0);
    CHECK_FALSE(box.update());
}

TEST_CASE("ring: first in, first out; full and empty are told, and a value refused is not half taken") {
    SpscRing<int> ring(5);
    CHECK(ring.room() == 8);
    int value = -1;
    CHECK_FALSE(ring.pop(value));
    CHECK(value == -1);
    for (int i = 0; i < 8; ++i) CHECK(ring.push(i));
    CHECK_FALSE(ring.push(99));
    CHECK(ring.waiting() == 8);
    CHECK(ring.pop(value));
    CHECK(value == 0);
    CHECK(ring.push(8));
    CHECK_FALSE(ring.push(99));
    for (int i = 1; i <= 8; ++i) {
        CHECK(ring.pop(value));
        CHECK(value == i);
    }
    CHECK_FALSE(ring.pop(value));
    CHECK(ring.waiting() == 0);
}

TEST_CASE("ring: a room of one, and of what was never asked for") {
    SpscRing<int> one(1);
    int value = 0;
    for (int i = 0; i < 100; ++i) {
        REQUIRE(one.push(i));
        REQUIRE_FALSE(one.push(i));
        REQUIRE(one.pop(value));
        REQUIRE(value == i);
    }
    CHECK(SpscRing<int>(0).room() == 1);
}

TEST_CASE(
    "ring: between threads every value arrives, once, in order and whole; what is refused is sent again") {
    constexpr std::uint64_t last = 20'000;
    SpscRing<Message> ring(16);
    std::uint64_t refused = 0;
    std::thread writer([&] {
        for (std::uint64_t n = 1; n <= last; ++n) {
            const Message m = message(n);
            while (!ring.push(m)) {
                ++refused;
                std::this_thread::yield();
            }
        }
    });
    std::uint64_t seen = 0, wrong = 0;
    Message m;
    while (seen < last) {
        if (!ring.pop(m)) {
            std::this_thread::yield();
            continue;
        }
        wrong += whole(m) && m.words[0] == seen + 1 ? 0U : 1U;
        seen = m.words[0];
    }
    writer.join();
    CHECK(wrong == 0);
    CHECK_FALSE(ring.pop(m));
    MESSAGE("refused and sent again: ", refused);
}
