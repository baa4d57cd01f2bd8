#include "haptics/glove/adapter.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <fstream>

using namespace bolt;
namespace fs = std::filesystem;

TEST_CASE("an adapter's patience is read by the port's real name; what is no adapter has none") {
    const fs::path folder = fs::temp_directory_path() / ("boltwright-adapter-" + std::to_string(getpid()));
    fs::create_directories(folder / "devices" / "ttyUSB3");
    std::ofstream(folder / "ttyUSB3") << "";
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "16\n";
    fs::create_symlink(folder / "ttyUSB3", folder / "usb-FTDI-if00");
    CHECK(glove::gathers_ms(folder / "usb-FTDI-if00", folder / "devices") == 16);
    CHECK_FALSE(glove::gathers_ms(folder / "ttyUSB4", folder / "devices"));
    std::ofstream(folder / "devices" / "ttyUSB3" / "latency_timer") << "none\n";
    CHECK_FALSE(glove::gathers_ms(folder / "ttyUSB3", folder / "devices"));
    fs::remove_all(folder);
}

TEST_CASE("a port that is not there is told from one that may be used") {
    CHECK(glove::may_use("/dev/null"));
    const Status none = glove::may_use("/dev/ttyNONE");
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plugged in") != std::string::npos);
}
