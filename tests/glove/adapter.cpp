#include "haptics/glove/adapter.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/folder.hpp"

using namespace bolt;
namespace fs = std::filesystem;

TEST_CASE("an adapter's patience is read by the port's real name; what is no adapter has none") {
    const test::Folder kept;
    const fs::path& folder = kept.path();
    fs::create_directories(folder / "devices" / "ttyUSB3");
    std::ofstream(folder / "ttyUSB3") << "";
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "16\n";
    fs::create_symlink(folder / "ttyUSB3", folder / "usb-FTDI-if00");
    CHECK(glove::gathers_ms(folder / "usb-FTDI-if00", folder / "devices") == 16);
    CHECK_FALSE(glove::gathers_ms(folder / "ttyUSB4", folder / "devices"));
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "none\n";
    CHECK_FALSE(glove::gathers_ms(folder / "ttyUSB3", folder / "devices"));
}

TEST_CASE("a port that is not there is told from one that may be used") {
    CHECK(glove::may_use("/dev/null"));
    const Status none = glove::may_use("/dev/ttyNONE");
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plugged in") != std::string::npos);
}
