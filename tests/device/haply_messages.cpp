// The messages of Haply's service.
#include "haptics/device/haply_messages.hpp"

#include <doctest/doctest.h>

#include <string>

namespace device_haply_messages_test {

using namespace bolt;
using namespace bolt::device;

namespace {

const HaplyArmEntry entry{"049D", true, Vec3(0.0)};
const HaplyGripEntry wireless_grip{"61576", true};

std::string state_message(std::string_view position, std::string_view grip = "[]") {
    return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)" + std::string(position) +
           R"(,"cursor_velocity":{"x":0,"y":0,"z":0}}}],"wireless_verse_grip":)" + std::string(grip) + "}";
}

}  // namespace

TEST_CASE("Haply: versions before 3.5 take other messages") {
    CHECK(is_old_haply_version(R"({"project_version": "3.0.0.0"})") == true);
    CHECK(is_old_haply_version(R"({"project_version": "3.4.1"})") == true);
    CHECK(is_old_haply_version(R"({"project_version": "3.5.0.0"})") == false);
    CHECK(is_old_haply_version(R"({"ok": true, "data": {"project_version": "3.10.2"}})") == false);
    CHECK(is_old_haply_version(R"({"project_version": "4.0"})") == false);
    for (const char* unknown : {"", "[]", "{}", R"({"project_version": 3.5})", R"({"project_version": "3"})",
                                R"({"project_version": "new.5"})", R"({"data": "3.4"})"})
        CHECK_FALSE(is_old_haply_version(unknown));
    CHECK(haply_force_message(entry, Vec3(1, 2, 3), false) ==
          R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":)"
          R"({"x":1.000000,"y":-3.000000,"z":2.000000}}}}]})");
    CHECK(haply_force_message(entry, Vec3(0.0), true).find(R"("values":{"x":0.000000)") != std::string::npos);
}

TEST_CASE("Haply: a list of devices with a missing or wrong field is an error") {
    const auto error_text = [](std::string_view message) {
        const auto inventory = parse_haply_inventory(message);
        return inventory ? std::string() : inventory.error().message();
    };
    CHECK(error_text("{}").empty());
    CHECK(error_text(R"({"inverse3": {}})") ==
          "Haply service: inverse3 is of type object; expected an array");
    CHECK(error_text(R"({"inverse3": [1]})") == "Haply service: device_id is missing; expected a string");
    CHECK(error_text(R"({"inverse3": [{"device_id": "A"}]})") ==
          "Haply service: status.calibrated is missing; expected true or false");
    CHECK(error_text(R"({"inverse3": [{"device_id": "A\"}", "status": {"calibrated": true}}]})")
              .find("device_id has unusual characters") != std::string::npos);
    CHECK(error_text(R"({"verse_grip": [{"device_id": 7}]})") ==
          "Haply service: device_id is of type number; expected a string");
    std::string many = R"({"inverse3": [0)";
    for (int i = 0; i < 16; ++i) many += ",0";
    CHECK(error_text(many + "]}") == "Haply service: inverse3 has 17 devices; expected at most 16");
    CHECK_FALSE(error_text(std::string(60'000, '[')).empty());
    CHECK_FALSE(error_text("{\"inverse3\": \"\xff\xfe\"}").empty());
}

TEST_CASE("Haply: a grip that sleeps is missing from a state; a wrong one is an error") {
    const char* position = R"({"x":0.01,"y":0.02,"z":0.03})";
    const auto asleep = parse_haply_state(state_message(position), entry, &wireless_grip);
    REQUIRE(asleep);
    CHECK_FALSE(asleep->orientation);
    CHECK(asleep->position == Vec3(0.01, 0.03, -0.02));
    const auto grip = [&](std::string_view state) {
        const auto read = parse_haply_state(
            state_message(position, R"([{"device_id":"61576","state":)" + std::string(state) + "}]"), entry,
            &wireless_grip);
        return read ? std::string() : read.error().message();
    };
    const std::string turn = R"("orientation":{"w":1,"x":0,"y":0,"z":0})";
    CHECK(grip("{" + turn + R"(,"buttons":{"a":true,"b":false,"c":false}})").empty());
    CHECK(grip("{" + turn + "}") == "Haply service: buttons.a is missing; expected true or false");
    CHECK(grip(R"({"buttons":{}})") == "Haply service: orientation is missing; expected an object");
    CHECK(grip(R"({"orientation":{"w":null}})") ==
          "Haply service: orientation.w is of type null; expected a number");
    CHECK(grip(R"({"orientation":{"w":0,"x":0,"y":0,"z":0}})") ==
          "Haply service: orientation has length 0; expected a unit quaternion");
    CHECK(parse_haply_state(state_message(position, "7"), entry, nullptr));
}

TEST_CASE("Haply: events of other devices, and events that are no loss, are ignored") {
    const auto loss = [](const char* name, const char* id, const char* more = "") {
        return loss_in_haply_event(
            R"({"name":")" + std::string(name) + R"(","data":{"device_id":")" + id + "\"" + more + "}}",
            entry);
    };
    CHECK(loss("device-disconnected", "049D"));
    CHECK_FALSE(loss("device-disconnected", "61576"));
    CHECK_FALSE(loss("device-connected", "049D"));
    CHECK(loss("device-safety-triggered", "049D", R"(,"safety_type":"stall_detected")"));
    CHECK_FALSE(loss("device-safety-triggered", "049D", R"(,"safety_type":"ebrake_released")"));
    CHECK_FALSE(loss("device-safety-triggered", "049D"));
    CHECK_FALSE(loss_in_haply_event("nonsense", entry));
    CHECK_FALSE(loss_in_haply_event(R"({"name":[],"data":[]})", entry));
}

}  // namespace device_haply_messages_test
