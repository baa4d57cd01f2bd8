#include "game/station/station_check.hpp"

#include <doctest/doctest.h>

#include "haptics/device/simulated_arm.hpp"

namespace station_check_test {

using namespace bolt;
using namespace bolt::station_setup;

namespace {

device::Description omega() {
    device::Description arm = device::simulated_arm_description();
    arm.id = "force-dimension:0";
    arm.buttons = 1;
    return arm;
}

// A file and facts without a finding.
struct Bench {
    content::StationFile station;
    StationFacts facts;
    Bench() {
        const device::Description arm = omega();
        station = station_of(&arm, nullptr);
        station.arm->tool = "wrench";
        facts.arm = arm;
        facts.tools = {"torque_wrench", "wrench"};
    }
    [[nodiscard]] std::string text() const { return describe(compare(station, facts)); }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Station check: a new file has what the device reports, and suits it") {
    Bench bench;
    CHECK(bench.text().empty());
    const content::StationMover& arm = *bench.station.arm;
    CHECK(arm.device == "force-dimension:0");
    CHECK(arm.buttons == station::Buttons{1, 0, 0, 0});
    CHECK(arm.limits.force == omega().limits.force);
    CHECK(arm.limits.stiffness == omega().limits.stiffness);
    CHECK(!arm.limits.torque);
    const auto again = content::parse_station(content::station_json(bench.station), "s.json");
    REQUIRE(again);
    CHECK(*again == bench.station);
    device::Description wheel;
    wheel.id = "1209:ffb0";
    const content::StationFile turns = station_of(nullptr, &wheel);
    CHECK(!turns.arm);
    CHECK(turns.wheel->device == "1209:ffb0");
    CHECK(turns.wheel->buttons == station::Buttons{0, 0, 0, 0});
}

TEST_CASE("Station check: a limit above the device's own is a warning, one below it is none") {
    Bench bench;
    bench.station.arm->limits.force = 5.0;
    CHECK(bench.text().empty());
    bench.station.arm->limits.force = 30.0;
    bench.station.arm->limits.torque = 0.2;  // the device renders none
    const auto findings = compare(bench.station, bench.facts);
    REQUIRE(findings.size() == 2);
    CHECK(!findings[0].prevents_use);
    CHECK(findings[0].text == "arm: the limit force_N is 30, above the device's own 12: it has no effect");
    CHECK(findings[1].text == "arm: the limit torque_Nm is 0.2, above the device's own 0: it has no effect");
}

TEST_CASE("Station check: buttons that the device does not have are problems, default ones are not") {
    Bench bench;
    bench.station.arm->buttons.reset();
    CHECK(bench.text().empty());
    bench.station.arm->buttons = station::Buttons{1, 2, 0, 0x80000000U};
    const auto findings = compare(bench.station, bench.facts);
    REQUIRE(findings.size() == 2);
    CHECK(findings[0].prevents_use);
    CHECK(findings[0].text == "arm: the button \"clutch\" is number 2, and the device has one button");
    CHECK(findings[1].text == "arm: the button \"reset\" is number 32, and the device has one button");
    bench.station.arm->buttons = station::Buttons{0, 1, 0, 0};
    CHECK(bench.text() ==
          "  warning: arm: no button switches the forces on: in a lesson the space bar does\n");
}

TEST_CASE("Station check: missing devices, a missing port and an unknown tool are problems, and come first") {
    Bench bench;
    bench.station.arm->limits.force = 30.0;
    bench.station.arm->tool = "wrensh";
    bench.station.wheel.emplace().device = "1209:ffb0";
    bench.facts.wheel =
        Result<device::Description>(fail(ErrorCode::no_device, "there is no device 1209:ffb0", "a wheel"));
    bench.facts.glove = fail(ErrorCode::no_device, "/dev/ttyUSB0 is not a serial port", "a port");
    const auto findings = compare(bench.station, bench.facts);
    REQUIRE(findings.size() == 4);
    CHECK(findings[0].text == "wheel: there is no device 1209:ffb0; expected a wheel");
    CHECK(contains(findings[1].text, "glove: /dev/ttyUSB0"));
    CHECK(findings[2].text == "arm: no assembly has a tool \"wrensh\"; did you mean \"wrench\"?");
    CHECK(!findings[3].prevents_use);
    bench.station.arm->tool = "xyz";
    CHECK(contains(bench.text(), "expected one of torque_wrench, wrench"));
}

TEST_CASE("Station check: a map that the device cannot follow is a warning") {
    Bench bench;
    bench.facts.arm = device::Description{};
    (*bench.facts.arm)->sensing = device::Sensing::velocity;
    (*bench.facts.arm)->limits.force = (*bench.facts.arm)->limits.torque = 0.0;
    bench.station.arm = content::StationMover{"puck", {}, 2.0, {}, {}, {}, 0.0, {}};
    CHECK(bench.text() == "  warning: arm: scale and power have no effect: the device senses a velocity\n");
}

TEST_CASE("Station check: a Vive tracker without its registration does not move the gloved hand") {
    Bench bench;
    bench.station.wrist_tracker = TrackerRole::right_wrist;
    CHECK(contains(bench.text(),
                   "warning: glove: the wrist is not registered with the Vive tracker right_wrist, so"));
    content::Registration& registered = bench.station.registrations.emplace_back();
    registered.from = content::CoordinateFrame::wrist_tracker;
    registered.to = content::CoordinateFrame::hand;
    CHECK(bench.text().empty());
}

TEST_CASE("Station check: a registration of a wheel, in an old file, is not used") {
    Bench bench;
    content::Registration& registered = bench.station.registrations.emplace_back();
    registered.from = content::CoordinateFrame::room;
    registered.to = content::CoordinateFrame::wheel;
    CHECK(contains(bench.text(),
                   "warning: a registration between \"room\" and \"wheel\" is not used: a wheel "
                   "turns one bolt after the other"));
    registered.to = content::CoordinateFrame::tracker;
    CHECK(bench.text().empty());
}

TEST_CASE("Station check: the shipped assemblies have the tools that a station can name") {
    const std::vector<std::string> tools = find_facts({}).tools;
    CHECK(std::find(tools.begin(), tools.end(), "torque_wrench") != tools.end());
    content::StationFile absent;
    absent.arm.emplace().device = "force-dimension:9";
    absent.glove_port = "/dev/ttyNONE";
    const StationFacts facts = find_facts(absent);
    REQUIRE(facts.arm);
    CHECK(!*facts.arm);
    CHECK(!facts.glove);
    CHECK(!facts.wheel);
}

}  // namespace station_check_test
