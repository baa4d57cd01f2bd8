#include "content/station/wheel_config_file.hpp"

#include <doctest/doctest.h>

using namespace bolt;
using namespace bolt::content;

namespace {

Result<device::WheelConfig> parsed(const std::string& members) {
    return parse_wheel_config("{\n  \"format\": \"boltwright rig 1\"" + members + "\n}\n", "rig.json");
}

}  // namespace

TEST_CASE("WheelConfigFile: given values are read, the others keep their defaults") {
    const auto rig = parsed(
        R"(, "full_torque_Nm": 8, "most_torque_Nm": 4.5, "counts_per_turn": 65536, "range_deg": 540, "reversed": true)");
    REQUIRE(rig);
    CHECK(rig->full_torque == 8.0);
    CHECK(rig->max_torque == 4.5);
    CHECK(rig->counts_per_turn == 65536.0);
    CHECK(rig->range == doctest::Approx(3.0 * pi).epsilon(1e-12));
    CHECK(rig->reversed);
    CHECK(rig->axis == device::WheelConfig{}.axis);

    const auto bare = parsed("");
    REQUIRE(bare);
    const device::WheelConfig usual;
    CHECK(bare->full_torque == usual.full_torque);
    CHECK(bare->max_torque == usual.max_torque);
    CHECK(bare->counts_per_turn == usual.counts_per_turn);
    CHECK(bare->range == usual.range);
    CHECK(!bare->reversed);
}

TEST_CASE("WheelConfigFile: errors name file, line and column") {
    const auto at = [](const std::string& members) {
        const auto rig = parsed(members);
        REQUIRE(!rig);
        CHECK(rig.error().code == ErrorCode::bad_content);
        return rig.error().message();
    };
    CHECK(at(",\n  \"most_torque_Nm\": 300").find("rig.json:3:21: ") == 0);
    CHECK(at(",\n  \"most_torque_Nm\": -1").find("rig.json:3:21") == 0);
    CHECK(at(",\n  \"full_torque_Nm\": 0").find("rig.json:3:21") == 0);
    CHECK(at(",\n  \"full_torque\": 8").find("rig.json:3:3: ") == 0);
    CHECK(at(",\n  \"reversed\": 1").find("rig.json:3:15") == 0);
    CHECK(at(",\n  \"counts_per_turn\": \"65536\"").find("rig.json:3:22") == 0);
    CHECK(parse_wheel_config("[]", "r").error().message().find("r:1:1") == 0);
    CHECK(parse_wheel_config(R"({"format": "boltwright rig 2"})", "r").error().message().find("r:1:12") == 0);
    CHECK(parse_wheel_config("", "r").error().code == ErrorCode::bad_content);
    CHECK(!load_wheel_config("no/such/rig.json"));
}
