#include "engine/base/feed.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <string>
#include <vector>

using namespace bolt;

TEST_CASE("a program gets what it is fed, all of it, and its exit code comes back") {
    std::vector<std::uint8_t> bytes(300'000, 'x');
    auto feed = Feed::start({"sh", "-c", "test $(wc -c) = 300000 && exit 7"});
    REQUIRE(feed);
    CHECK(feed->write(bytes));
    CHECK(feed->finish() == 7);
    CHECK(feed->finish() == -1);  // it has ended already
}

TEST_CASE("a program that is not there cannot be started; one that ends early takes no more") {
    const auto missing = Feed::start({"no-such-program-of-boltwright"});
    REQUIRE_FALSE(missing);
    CHECK(missing.error().what.find("cannot be started") != std::string::npos);
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    auto feed = Feed::start({"true"});
    REQUIRE(feed);
    const std::vector<std::uint8_t> bytes(1'000'000, 'x');
    const Status written = feed->write(bytes);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find("takes no more") != std::string::npos);
    CHECK(feed->finish() == 0);
    (void)std::signal(SIGPIPE, before);
}
