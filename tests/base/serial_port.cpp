#include "engine/base/serial_port.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/folder.hpp"

using namespace bolt;
namespace fs = std::filesystem;

TEST_CASE("SerialPort: the latency timer is found by the port's real name; other ports have none") {
    const test::Folder kept;
    const fs::path& folder = kept.path();
    fs::create_directories(folder / "devices" / "ttyUSB3");
    std::ofstream(folder / "ttyUSB3") << "";
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "16\n";
    fs::create_symlink(folder / "ttyUSB3", folder / "usb-FTDI-if00");
    CHECK(latency_timer_ms(folder / "usb-FTDI-if00", folder / "devices") == 16);
    CHECK_FALSE(latency_timer_ms(folder / "ttyUSB4", folder / "devices"));
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "none\n";
    CHECK_FALSE(latency_timer_ms(folder / "ttyUSB3", folder / "devices"));
}

TEST_CASE("SerialPort: a missing port differs from a usable one") {
    CHECK(check_port_access("/dev/null"));
    const Status none = check_port_access("/dev/ttyNONE");
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plugged in") != std::string::npos);
}

TEST_CASE("SerialPort: a path that is not a port is an error with a remedy") {
    const auto none = SerialPort::open("/nonexistent/glove");
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plugged in") != std::string::npos);
    const auto file = SerialPort::open("/dev/null");
    REQUIRE(!file);
    CHECK(file.error().message().find("not a serial port") != std::string::npos);
}
