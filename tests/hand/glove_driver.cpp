// The driver on a pseudo-terminal with the emulated glove at its other end. The tests wait for events without
// time limits of their own; glove_session.cpp tests delays in virtual time.
#include "haptics/hand/glove_driver.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <thread>

#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::hand;
using bolt::test::eventually;

TEST_CASE("GloveDriver: gloves of both sizes and hands stream through a pseudo-terminal") {
    for (const std::size_t sensors : {18U, 22U})
        for (const Side hand : {Side::left, Side::right}) {
            auto line =
                emulate::SerialGlove::start({.sensors = sensors, .hand = hand, .streaming = true}, 0.5);
            REQUIRE(line);
            GloveDriver driver = GloveDriver::start(line->port());
            std::uint64_t last = 0;
            bool in_order = true;
            REQUIRE(eventually([&] {
                const std::uint64_t number = driver.sample().number;
                in_order = in_order && number >= last;
                last = number;
                return number > 40;
            }));
            CHECK(in_order);
            CHECK(driver.report().identity.sensors == sensors);
            CHECK(driver.report().identity.side == hand);
            CHECK(driver.report().lost_bytes == 0);
            CHECK((driver.sample().frame.raw[index(Sensor::ring_dij)] == 0) == (sensors == 18));
        }
}

TEST_CASE("GloveDriver: recovers from a stall and from a port that vanishes and returns") {
    const test::Folder folder;
    const auto name = folder / "glove";
    const auto plug_in = [&](const emulate::SerialGlove& line) {
        std::filesystem::remove(name);
        std::filesystem::create_symlink(line.port(), name);
    };
    auto line = emulate::SerialGlove::start({}, 0.5);
    REQUIRE(line);
    plug_in(*line);
    GloveDriver driver = GloveDriver::start(name);
    REQUIRE(eventually([&] { return driver.sample().number > 5; }));

    line->stall(true);
    REQUIRE(eventually([&] { return driver.report().state == GloveState::silent; }));
    CHECK(std::strlen(driver.report().fault_message.data()) > 0);
    const std::uint64_t at = driver.sample().number;
    line->stall(false);
    REQUIRE(eventually([&] { return driver.sample().number > at + 5; }));

    { const emulate::SerialGlove pulled = std::move(*line); }
    REQUIRE(eventually([&] { return !driver.report().open; }));
    CHECK(std::strlen(driver.report().fault_message.data()) > 0);
    auto again = emulate::SerialGlove::start({.sensors = 22}, 0.5);
    REQUIRE(again);
    plug_in(*again);
    REQUIRE(eventually([&] { return driver.report().identity.sensors == 22; }));
    const std::uint64_t then = driver.sample().number;
    REQUIRE(eventually([&] { return driver.sample().number > then + 5; }));
    CHECK(driver.report().openings >= 2);
    std::filesystem::remove(name);
}
