#include <doctest/doctest.h>
#include <fnmatch.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "haptics/device/connected_devices.hpp"

using namespace bolt;
using namespace bolt::device;

namespace {

const std::filesystem::path rules = BOLT_UDEV_RULES;

// Returns true if the rule grants the logged-in user access to the device with this kernel name.
bool gives(const std::string& line, const std::string& kernel_name) {
    static const std::regex rule(R"re(^KERNEL=="hidraw\*", KERNELS=="([^"]+)", TAG\+="uaccess"$)re");
    std::smatch match;
    return std::regex_match(line, match, rule) &&
           fnmatch(match[1].str().c_str(), kernel_name.c_str(), 0) == 0;
}

bool any_gives(const std::string& kernel_name) {
    std::ifstream file(rules);
    for (std::string line; std::getline(file, line);)
        if (gives(line, kernel_name)) return true;
    return false;
}

}  // namespace

TEST_CASE("Udev: the shipped rule covers pucks and OpenFFBoards and no keyboard") {
    CHECK(rules.filename() < "73-seat-late.rules");
    for (const char* ours :
         {"0003:256F:C62E.0001", "0003:256F:C652.00AF", "0005:256F:C63A.0002", "0003:046D:C626.0001",
          "0003:046D:C62B.0004", "0003:046D:C603.0004", "0003:1209:FFB0.0011"})
        CHECK_MESSAGE(any_gives(ours), ours);
    for (const char* others :
         {"0003:046D:C52B.0001", "0003:046D:C077.0001", "0003:1209:FFB1.0001", "0003:256:C62E.1"})
        CHECK_MESSAGE(!any_gives(others), others);
}

TEST_CASE("Udev: udev_rule() for another wheel matches that wheel only") {
    const std::string line = udev_rule({0x0eb7, 0x0e03, "Some wheel", ""});
    CHECK(gives(line, "0003:0EB7:0E03.0007"));
    CHECK(!gives(line, "0003:0EB7:0E04.0007"));
}
