#include "haptics/hand/glove_driver.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/folder.hpp"

using namespace bolt;
namespace fs = std::filesystem;

TEST_CASE("GloveAdapter: the latency timer is found by the port's real name; other ports have none") {
    const test::Folder kept;
    const fs::path& folder = kept.path();
    fs::create_directories(folder / "devices" / "ttyUSB3");
    std::ofstream(folder / "ttyUSB3") << "";
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "16\n";
    fs::create_symlink(folder / "ttyUSB3", folder / "usb-FTDI-if00");
    CHECK(hand::latency_timer_ms(folder / "usb-FTDI-if00", folder / "devices") == 16);
    CHECK_FALSE(hand::latency_timer_ms(folder / "ttyUSB4", folder / "devices"));
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "none\n";
    CHECK_FALSE(hand::latency_timer_ms(folder / "ttyUSB3", folder / "devices"));
}

TEST_CASE("GloveAdapter: a missing port differs from a usable one") {
    CHECK(hand::check_port_access("/dev/null"));
    const Status none = hand::check_port_access("/dev/ttyNONE");
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plugged in") != std::string::npos);
}
