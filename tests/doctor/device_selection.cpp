#include "game/station/station_setup.hpp"

#include <doctest/doctest.h>

using namespace bolt;
using namespace bolt::station_setup;
using device::DeviceKind;
using device::ListedDevice;

namespace {

ListedDevice device_of(const std::string& id, DeviceKind kind, const char* what = nullptr) {
    ListedDevice l{"/dev/hidraw0", id, "a " + id, kind, std::nullopt};
    if (what != nullptr) {
        l.error.emplace();
        l.error->code = ErrorCode::no_device;
        l.error->what = what;
    }
    return l;
}

const std::vector<ListedDevice> connected{
    device_of("256f:c62e", DeviceKind::puck, "may not be opened"), device_of("046d:c626", DeviceKind::puck),
    device_of("1234:5678", DeviceKind::wheel), device_of("1209:ffb0", DeviceKind::open_ffboard),
    device_of("0000:0001", DeviceKind::other)};

Result<DeviceSelection> selected(const std::vector<std::string>& ids) {
    return select_devices(connected, ids);
}

std::string error_of(const std::vector<std::string>& ids) {
    const Result<DeviceSelection> selection = selected(ids);
    return selection ? "" : selection.error().message();
}

}  // namespace

TEST_CASE("Selection: a puck is the mover and a wheel or board the wheel, in any order") {
    CHECK(!selected({})->mover);
    for (const auto& ids : {std::vector<std::string>{"046d:c626", "1209:ffb0"}, {"1209:ffb0", "046d:c626"}}) {
        const Result<DeviceSelection> both = selected(ids);
        REQUIRE(both);
        CHECK(both->mover->id == "046d:c626");
        CHECK(both->wheel->id == "1209:ffb0");
        CHECK(ids_of(*both) == std::vector<std::string>{"046d:c626", "1209:ffb0"});
    }
    CHECK(selected({"1234:5678"})->wheel->id == "1234:5678");
    CHECK(!selected({"1234:5678"})->mover);
}

TEST_CASE("Selection: missing, unusable and duplicate devices are errors that name the remedy") {
    CHECK(error_of({"1209:ffb1"}).find("did you mean 1209:ffb0?") != std::string::npos);
    CHECK(error_of({"dead:beef"}).find("boltwright devices") != std::string::npos);
    CHECK(selected({"dead:beef"}).error().code == ErrorCode::no_device);
    CHECK(error_of({"256f:c62e"}) == "may not be opened");
    CHECK(error_of({"0000:0001"}).find("cannot be used for training") != std::string::npos);
    CHECK(error_of({"1234:5678", "1209:ffb0"}).find("only one of them") != std::string::npos);
    CHECK(selected({"1209:ffb0", "1209:ffb0"}).error().code == ErrorCode::usage);
}

TEST_CASE("Selection: without ids the first usable device of each role is taken") {
    CHECK(ids_of(select_any_devices(connected)) == std::vector<std::string>{"046d:c626", "1234:5678"});
    CHECK(ids_of(select_any_devices({})).empty());
    CHECK(ids_of(select_any_devices(std::span(connected).first(1))).empty());
}

TEST_CASE("Selection: a station file names the devices, and the command line has precedence") {
    content::StationFile station;
    station.arm.emplace().device = "046d:c626";
    station.wheel.emplace().device = "1209:ffb0";
    using Ids = std::vector<std::string>;
    const auto added = [&](Ids ids) -> Result<Ids> {
        BOLT_TRY(add_devices_of(station, connected, ids));
        return ids;
    };
    CHECK(added({}) == Ids{"046d:c626", "1209:ffb0"});
    CHECK(added({"046d:c626"}) == Ids{"046d:c626"});
    CHECK(added({"1209:ffb0"}) == Ids{"1209:ffb0"});
    const auto error = [&](Ids ids) {
        const auto all = added(std::move(ids));
        REQUIRE(!all);
        return all.error();
    };
    CHECK(error({"1234:5678"}).code == ErrorCode::usage);
    CHECK(error({"046d:c626", "1234:5678"}).message() ==
          "--device 1234:5678: the settings of the station's \"wheel\" are for 1209:ffb0; expected that "
          "device, or no --station");
    station.arm->device = "1234:5678";
    CHECK(error({}).code == ErrorCode::bad_content);
    CHECK(error({}).message().find("1234:5678 is the \"arm\" of the station") == 0);
    // A device that is not connected is an error of select_devices().
    station.arm->device = "046d:ffff";
    CHECK(added({}) == Ids{"046d:ffff", "1209:ffb0"});
    station = {};
    CHECK(added({}) == Ids{});
    CHECK(added({"1234:5678"}) == Ids{"1234:5678"});
}
