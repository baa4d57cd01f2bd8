// Mailboxes with real threads; the results do not depend on the threads' speed. ThreadSanitizer detects a
// missing release or acquire: BOLT_TEST=tsan ./test -R base
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/base/lock_free.hpp"
#include "engine/base/random.hpp"

using namespace bolt;

namespace {

// Too large for an atomic copy. Every word is computed from the first, so that a torn copy is detectable.
struct Message {
    std::array<std::uint64_t, 40> words{};
};

Message message(std::uint64_t n) {
    Message m;
    for (std::size_t i = 0; i < m.words.size(); ++i) m.words[i] = n * (2 * i + 1);
    return m;
}

bool complete(const Message& m) { return m.words == message(m.words[0]).words; }

}  // namespace

TEST_CASE("TripleBuffer: no update at first, then the latest value, once") {
    TripleBuffer<int> buffer(7);
    CHECK_FALSE(buffer.update());
    CHECK(buffer.latest() == 7);
    buffer.write(1);
    CHECK(buffer.latest() == 7);  // the reader's value changes only in update()
    CHECK(buffer.update());
    CHECK(buffer.latest() == 1);
    CHECK_FALSE(buffer.update());
    for (int i = 2; i <= 10; ++i) buffer.write(i);
    CHECK(buffer.update());
    CHECK(buffer.latest() == 10);
    CHECK_FALSE(buffer.update());
    CHECK(buffer.latest() == 10);
}

TEST_CASE("TripleBuffer: a slot is not visible before it is published") {
    TripleBuffer<int> buffer(0);
    buffer.slot() = 5;
    CHECK_FALSE(buffer.update());
    CHECK(buffer.latest() == 0);
    buffer.publish();
    CHECK(buffer.update());
    CHECK(buffer.latest() == 5);
}

TEST_CASE("TripleBuffer: in any order of polls and writes, a poll gives the last value written before it") {
    Random random(1);
    TripleBuffer<int> buffer(0);
    int written = 0, seen = 0;
    for (int i = 0; i < 100'000; ++i) {
        if (random.chance(0.5)) {
            buffer.write(++written);
        } else {
            REQUIRE(buffer.update() == (written != seen));
            seen = written;
            REQUIRE(buffer.latest() == seen);
        }
    }
}

TEST_CASE("TripleBuffer: a reader on another thread sees complete values in order") {
    constexpr std::uint64_t last = 20'000;
    TripleBuffer<Message> buffer(message(0));
    std::thread writer([&buffer] {
        for (std::uint64_t n = 1; n <= last; ++n) buffer.write(message(n));
    });
    std::uint64_t seen = 0, torn = 0, back = 0;
    while (seen < last) {
        if (!buffer.update()) {
            std::this_thread::yield();
            continue;
        }
        const Message& m = buffer.latest();
        torn += complete(m) ? 0U : 1U;
        back += m.words[0] > seen ? 0U : 1U;
        seen = m.words[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(back == 0);
    CHECK_FALSE(buffer.update());
}

TEST_CASE(
    "SpscRing: first in, first out; a push into a full ring and a pop from an empty one change nothing") {
    SpscRing<int> ring(5);
    CHECK(ring.capacity() == 8);
    int value = -1;
    CHECK_FALSE(ring.pop(value));
    CHECK(value == -1);
    for (int i = 0; i < 8; ++i) CHECK(ring.push(i));
    CHECK_FALSE(ring.push(99));
    CHECK(ring.size() == 8);
    CHECK(ring.pop(value));
    CHECK(value == 0);
    CHECK(ring.push(8));
    CHECK_FALSE(ring.push(99));
    for (int i = 1; i <= 8; ++i) {
        CHECK(ring.pop(value));
        CHECK(value == i);
    }
    CHECK_FALSE(ring.pop(value));
    CHECK(ring.size() == 0);
}

TEST_CASE("SpscRing: capacity of one, and of zero rounded up to one") {
    SpscRing<int> one(1);
    int value = 0;
    for (int i = 0; i < 100; ++i) {
        REQUIRE(one.push(i));
        REQUIRE_FALSE(one.push(i));
        REQUIRE(one.pop(value));
        REQUIRE(value == i);
    }
    CHECK(SpscRing<int>(0).capacity() == 1);
}

TEST_CASE(
    "SpscRing: between threads every value arrives once, in order and complete; rejected ones are retried") {
    constexpr std::uint64_t last = 20'000;
    SpscRing<Message> ring(16);
    std::uint64_t rejected = 0;
    std::thread writer([&] {
        for (std::uint64_t n = 1; n <= last; ++n) {
            const Message m = message(n);
            while (!ring.push(m)) {
                ++rejected;
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
        wrong += complete(m) && m.words[0] == seen + 1 ? 0U : 1U;
        seen = m.words[0];
    }
    writer.join();
    CHECK(wrong == 0);
    CHECK_FALSE(ring.pop(m));
    MESSAGE("rejected and retried: ", rejected);
}
