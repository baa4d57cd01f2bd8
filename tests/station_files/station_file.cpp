#include "content/station/station_file.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "content/format/folders.hpp"
#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"

namespace station_file_test {

using namespace bolt;
using namespace bolt::content;
using nlohmann::json;

namespace {

const char* const everything = R"({
  "$schema": "station.schema.json", "format": "boltwright station 1", "name": "Lab 2",
  "arm": {
    "device": "force-dimension:0",
    "mounting": {"yaw_deg": 90, "pitch_deg": -10, "roll_deg": 180},
    "scale": 2.5, "power": 0.5, "effector_mass_kg": 0.2,
    "buttons": {"dead_man": [1, 3], "clutch": 2, "stop": 4, "reset": []},
    "limits": {"force_N": 8, "torque_Nm": 0.1, "stiffness_N_per_m": 1500, "torsion_Nm_per_rad": 5,
               "damping_Ns_per_m": 4, "angular_damping_Nms_per_rad": 0.01},
    "tool": "torque_wrench"
  },
  "wheel": {"device": "1209:ffb0", "full_torque_Nm": 8, "most_torque_Nm": 4, "counts_per_turn": 65536,
            "range_deg": 540, "reversed": true, "buttons": {"clutch": 7}},
  "glove": {"port": "/dev/ttyUSB0", "wrist_tracker": "right_elbow"},
  "registrations": [
    {"from": "arm", "to": "room", "date": "2026-03-02T09:15:00Z", "position_m": [0.4, 0.7, -0.3],
     "orientation_wxyz": [0.6, 0, 0.8, 0], "points": 7, "rms_m": 0.001, "largest_left_out_m": 0.003,
     "check_point": {"from_m": [0.05, 0, 0.02], "to_m": [0.41, 0.7, -0.35]},
     "tip_m": [0, 0.01, 0.12]}
  ]
})";

Result<StationFile> parsed(const std::string& members) {
    return parse_station("{\n\"format\": \"boltwright station 1\"" + members + "\n}\n", "s.json");
}

// The message for a file whose third line has these members.
std::string error_of(const std::string& members) {
    const Result<StationFile> station = parsed(",\n" + members);
    REQUIRE_MESSAGE(!station, members);
    CHECK(station.error().code == ErrorCode::bad_content);
    CHECK(station.error().line > 0);
    return station.error().message();
}

bool reads(const json& document) { return parse_station(document.dump(), "s.json").has_value(); }

json schema() {
    const auto text =
        read_file(content_folder() / "schema" / "station.schema.json", 1U << 20U, ErrorCode::failed);
    REQUIRE(text);
    return json::parse(*text);
}

// Visits every property of the schema with the pointer of its value in a document.
void each_property(const json& schema, const json& node, const json::json_pointer& at,
                   const std::function<void(const json::json_pointer&, const json&)>& visit) {
    const auto resolved = [&](const json& inner) -> const json& {
        return inner.contains("$ref")
                   ? schema.at(json::json_pointer(inner["$ref"].get<std::string>().substr(1)))
                   : inner;
    };
    if (node.contains("items") && resolved(node["items"]).contains("properties"))
        each_property(schema, resolved(node["items"]), at / std::size_t{0}, visit);
    if (!node.contains("properties")) return;
    CHECK(node["additionalProperties"] == false);
    for (const auto& entry : node["properties"].items()) {
        const std::string& name = entry.key();
        const auto& property = entry.value();
        const json& target = resolved(property);
        CHECK_MESSAGE((property.contains("title") || target.contains("title")), name);
        CHECK_MESSAGE((property.contains("description") || target.contains("description")), name);
        visit(at / name, target);
        each_property(schema, target, at / name, visit);
    }
}

Registration any_registration(Random& random, CoordinateFrame from) {
    Registration one;
    one.from = from;
    one.date = "2026-03-02T09:15:59Z";
    const auto point = [&] {
        return Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    };
    one.pose = {point(), random_turn(random)};
    one.points = 4 + static_cast<int>(random.bits() % 20);
    one.rms = random.uniform(0.0, 0.01);
    if (random.chance(0.5)) one.largest_left_out = random.uniform(0.01, 0.02);
    if (random.chance(0.5)) one.check_point = PointPair{point(), point()};
    if (random.chance(0.5)) one.tip = point();
    return one;
}

StationFile any_station(Random& random) {
    StationFile station;
    const auto maybe = [&](std::optional<double>& value, double low, double high) {
        if (random.chance(0.5)) value = random.uniform(low, high);
    };
    const auto buttons = [&]() -> std::optional<station::Buttons> {
        if (random.chance(0.3)) return std::nullopt;
        station::Buttons b{0, 0, 0, 0};
        for (std::uint32_t bit = 1; bit != 0; bit <<= 1U) {  // at most one function a button
            std::uint32_t* const functions[] = {&b.dead_man, &b.clutch, &b.stop, &b.reset};
            if (const std::uint32_t i = random.bits() % 12; i < 4) *functions[i] |= bit;
        }
        return b;
    };
    if (random.chance(0.5)) station.name = "Lab „2“";
    if (random.chance(0.5)) station.glove_port = "/dev/ttyUSB0";
    if (!station.glove_port.empty() && random.chance(0.5))
        station.wrist_tracker =
            static_cast<TrackerRole>(static_cast<std::size_t>(random.uniform(0.0, tracker_role_count)));
    if (random.chance(0.8)) {
        StationMover& arm = station.arm.emplace();
        arm.device = "haply:0";
        for (double Mounting::*angle : {&Mounting::yaw, &Mounting::pitch, &Mounting::roll})
            arm.mounting.*angle = to_radians(random.chance(0.3) ? 90.0 : random.uniform(-360.0, 360.0));
        maybe(arm.scale, 0.1, 20.0);
        if (random.chance(0.5)) arm.effector_mass = random.uniform(0.001, 1.0);
        maybe(arm.power_ratio, 0.01, 10.0);
        arm.buttons = buttons();
        maybe(arm.limits.force, 0.0, 1000.0);
        maybe(arm.limits.torque, 0.0, 30.0);
        maybe(arm.limits.stiffness, 50.0, 1e5);
        maybe(arm.limits.torsion, 0.1, 1000.0);
        maybe(arm.limits.damping, 0.0, 1000.0);
        maybe(arm.limits.angular_damping, 0.0, 10.0);
        if (random.chance(0.5)) arm.tool = "wrench";
    }
    if (random.chance(0.8)) {
        StationWheel& wheel = station.wheel.emplace();
        wheel.device = "1209:ffb0:\"7\"";
        wheel.config.full_torque = random.uniform(0.1, 30.0);
        wheel.config.range = to_radians(random.uniform(10.0, 65535.0));
        wheel.config.reversed = random.chance(0.5);
        wheel.buttons = buttons();
    }
    for (const CoordinateFrame from :
         {CoordinateFrame::arm, CoordinateFrame::tracker, CoordinateFrame::workpiece})
        if (random.chance(0.3)) station.registrations.push_back(any_registration(random, from));
    return station;
}

}  // namespace

TEST_CASE("Station file: every member is read, and absent ones keep their defaults") {
    const Result<StationFile> station = parse_station(everything, "s.json");
    REQUIRE_MESSAGE(station, (station ? "" : station.error().message()));
    CHECK(station->schema == "station.schema.json");
    CHECK(station->name == "Lab 2");
    REQUIRE(station->arm);
    const StationMover& arm = *station->arm;
    CHECK(arm.device == "force-dimension:0");
    CHECK(arm.mounting == Mounting{to_radians(90.0), to_radians(-10.0), to_radians(180.0)});
    CHECK(arm.scale == 2.5);
    CHECK(arm.effector_mass == 0.2);
    CHECK(arm.power_ratio == 0.5);
    CHECK(arm.buttons == station::Buttons{5, 2, 8, 0});
    CHECK(arm.limits == force::LimitBounds{8.0, 0.1, 1500.0, 5.0, 4.0, 0.01});
    CHECK(arm.tool == "torque_wrench");
    REQUIRE(station->wheel);
    CHECK(station->wheel->device == "1209:ffb0");
    CHECK(station->wheel->config.full_torque == 8.0);
    CHECK(station->wheel->config.max_torque == 4.0);
    CHECK(station->wheel->config.counts_per_turn == 65536.0);
    CHECK(station->wheel->config.range == doctest::Approx(3.0 * pi).epsilon(1e-12));
    CHECK(station->wheel->config.reversed);
    CHECK(station->wheel->buttons == station::Buttons{1, 64, 0, 0});
    CHECK(station->glove_port == "/dev/ttyUSB0");
    CHECK(station->wrist_tracker == TrackerRole::right_elbow);
    REQUIRE(station->registrations.size() == 1);
    const Registration& one = station->registrations[0];
    CHECK(one.from == CoordinateFrame::arm);
    CHECK(one.to == CoordinateFrame::room);
    CHECK(one.date == "2026-03-02T09:15:00Z");
    CHECK(one.pose.position == Vec3(0.4, 0.7, -0.3));
    CHECK(one.pose.orientation == Quat(0.6, 0.0, 0.8, 0.0));
    CHECK(one.points == 7);
    CHECK(one.rms == 0.001);
    CHECK(one.largest_left_out == 0.003);
    REQUIRE(one.check_point);
    CHECK(one.check_point->from == Vec3(0.05, 0.0, 0.02));
    CHECK(one.check_point->to == Vec3(0.41, 0.7, -0.35));
    CHECK(one.tip == Vec3(0.0, 0.01, 0.12));

    const Result<StationFile> bare = parsed("");
    REQUIRE(bare);
    CHECK(*bare == StationFile{});
    const Result<StationFile> plain = parsed(R"(, "arm": {"device": "a"}, "wheel": {"device": "w"})");
    REQUIRE(plain);
    CHECK(*plain->arm == StationMover{"a", {}, {}, {}, {}, {}, 0.0, {}});
    CHECK(*plain->wheel == StationWheel{"w", {}, {}});
}

TEST_CASE("Station file: errors name file, line and column, and what is expected") {
    const auto starts = [](const std::string& members, const std::string& beginning) {
        const std::string message = error_of(members);
        CHECK_MESSAGE(message.find(beginning) == 0, message);
    };
    starts(R"("arms": {})", "s.json:3:1: /arms: ");
    starts(R"("arm": [])", "s.json:3:8: /arm: \"arm\" is not an object; expected an object");
    starts(R"("arm": {})", "s.json:3:8: /arm: \"device\" is missing; expected the id of a device");
    starts(R"("arm": {"device": ""})", "s.json:3:19: ");
    starts(R"("arm": {"device": 1})", "s.json:3:19: ");
    starts(R"("arm": {"device": "a", "scale": 0})",
           "s.json:3:33: /arm/scale: \"scale\" cannot be \"0\"; "
           "expected a number from 0.1 to 20");
    starts(R"("arm": {"device": "a", "power": 11})", "s.json:3:33: ");
    starts(R"("arm": {"device": "a", "home": 0})", "s.json:3:24: ");
    starts(R"("arm": {"device": "a", "tool": 7})", "s.json:3:32: ");
    starts(R"("arm": {"device": "a", "mounting": "left"})", "s.json:3:36: ");
    starts(R"("arm": {"device": "a", "mounting": {"yaw": 90}})", "s.json:3:37: ");
    starts(R"("arm": {"device": "a", "mounting": {"yaw_deg": 361}})", "s.json:3:48: ");
    starts(R"("arm": {"device": "a", "limits": {"force_N": -1}})", "s.json:3:46: ");
    starts(R"("arm": {"device": "a", "limits": {"force": 1}})", "s.json:3:35: ");
    starts(R"("arm": {"device": "a", "buttons": {"dead_man": 0}})", "s.json:3:48: ");
    starts(R"("arm": {"device": "a", "buttons": {"dead_man": [1, 33]}})", "s.json:3:52: ");
    starts(R"("arm": {"device": "a", "buttons": {"dead_man": 1.5}})", "s.json:3:48: ");
    starts(R"("arm": {"device": "a", "buttons": {"deadman": 1}})", "s.json:3:36: ");
    starts(R"("wheel": {"device": "w", "full_torque_Nm": 0})", "s.json:3:44: ");
    starts(R"("wheel": {"device": "w", "reversed": 1})", "s.json:3:38: ");
    starts(R"("wheel": {"device": "w", "limits": {}})", "s.json:3:26: ");
    starts(R"("wheel": {"full_torque_Nm": 1})", "s.json:3:10: ");
    starts(R"("glove": {})", "s.json:3:10: /glove: \"port\" is missing; expected a serial port");
    starts(R"("glove": {"port": "p", "hand": "left"})", "s.json:3:24: ");
    starts(
        R"("glove": {"port": "p", "wrist_tracker": "right_wirst"})",
        "s.json:3:41: /glove/wrist_tracker: \"right_wirst\" is not a role of a Vive tracker; did you mean");
    starts(R"("glove": {"port": "p", "wrist_tracker": 3})", "s.json:3:41: ");
    starts(R"("name": 5)", "s.json:3:9: ");
    CHECK(parse_station("[]", "s").error().message().find("s:1:1") == 0);
    CHECK(parse_station("", "s").error().code == ErrorCode::bad_content);
    CHECK(parse_station(R"({"name": "x"})", "s").error().message().find("\"format\" is missing") !=
          std::string::npos);
    CHECK(parse_station(R"({"format": "boltwright rig 1"})", "s").error().message().find("s:1:12") == 0);
    CHECK(!load_station("no/such/station.json"));
}

TEST_CASE("Station file: a button with two functions is an error, also if one of them is the default") {
    CHECK(error_of(R"("arm": {"device": "a", "buttons": {"stop": 4, "reset": [3, 4]}})")
              .find("\"stop\" has a button that is also \"reset\"; expected another button") !=
          std::string::npos);
    CHECK(error_of(R"("arm": {"device": "a", "buttons": {"stop": 2}})")
              .find("also \"clutch\", as it is unless given") != std::string::npos);
    const auto swapped = parsed(R"(, "arm": {"device": "a", "buttons": {"dead_man": 2, "clutch": 1}})");
    REQUIRE(swapped);
    CHECK(swapped->arm->buttons == station::Buttons{2, 1, 0, 0});
}

TEST_CASE(
    "Station file: a file that is written is read back to the same bits, and refused where it would not be") {
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const StationFile station = any_station(random);
        const std::string text = station_json(station);
        const Result<StationFile> again = parse_station(text, "s.json");
        REQUIRE_MESSAGE(again, (again ? "" : again.error().message() + text));
        REQUIRE(*again == station);
        REQUIRE(station_json(*again) == text);
    }
    const test::Folder folder;
    const auto path = folder / "station.json";
    StationFile station = any_station(random);
    REQUIRE(save_station(path, station));
    const Result<StationFile> loaded = load_station(path);
    REQUIRE(loaded);
    CHECK(*loaded == station);
    StationFile wrong = station;
    wrong.arm.emplace().device.clear();
    CHECK(!save_station(path, wrong));
    CHECK(*load_station(path) == station);
}

TEST_CASE("Station file: the schema has exactly the members and bounds of the reader") {
    const json all = json::parse(everything);
    const json rules = schema();
    int count = 0;
    each_property(rules, rules, json::json_pointer(),
                  [&](const json::json_pointer& at, const json& property) {
                      CAPTURE(at.to_string());
                      ++count;
                      // The reader takes the member, and only under this name.
                      const bool same_as_of_arm = at.to_string().find("/wheel/buttons/") == 0;
                      if (!same_as_of_arm) REQUIRE(all.contains(at));
                      json misspelt = all;
                      if (all.contains(at)) misspelt.at(at.parent_pointer()).erase(at.back());
                      misspelt[at.parent_pointer() / (at.back() + "x")] = 1;
                      CHECK(!reads(misspelt));
                      json other = all;
                      other[at] = nullptr;
                      CHECK(!reads(other));
                      if (property.value("type", "") != "number") return;
                      // A bound of one residual may not contradict the other residual.
                      if (at.back() == "rms_m") other.at(at.parent_pointer()).erase("largest_left_out_m");
                      if (at.back() == "largest_left_out_m") other[at.parent_pointer() / "rms_m"] = 0.0;
                      for (const auto& [bound, beyond] : {std::pair{"minimum", -1.0}, {"maximum", 1.0}}) {
                          REQUIRE(property.contains(bound));
                          const auto value = property[bound].get<double>();
                          other[at] = value;
                          CHECK(reads(other));
                          other[at] = std::nextafter(value, beyond * 1e9);
                          CHECK(!reads(other));
                      }
                  });
    CHECK(count == 53);
    const std::vector<std::string> roles(tracker_role_names.begin(), tracker_role_names.end());
    CHECK(rules["properties"]["glove"]["properties"]["wrist_tracker"]["enum"] == roles);
    CHECK(rules["definitions"]["frame"]["enum"] == coordinate_frame_names());
    // No member of the reader is missing in the schema: the file with every member has no others.
    const std::function<void(const json&, const json&)> check = [&](const json& value, const json& node) {
        const json& rule = node.contains("$ref")
                               ? rules.at(json::json_pointer(node["$ref"].get<std::string>().substr(1)))
                               : node;
        if (value.is_array() && !value.empty() && value[0].is_object()) check(value[0], rule["items"]);
        if (!value.is_object()) return;
        for (const auto& entry : value.items()) {
            const std::string& name = entry.key();
            const auto& member = entry.value();
            CAPTURE(name);
            REQUIRE(rule["properties"].contains(name));
            check(member, rule["properties"][name]);
        }
    };
    check(all, rules);
    const std::function<void(const json&, json::json_pointer)> required = [&](const json& value,
                                                                              json::json_pointer at) {
        if (value.is_array() && !value.empty() && value[0].is_object())
            required(value[0], at / std::size_t{0});
        if (!value.is_object()) return;
        const bool registers = at.to_string() == "/registrations/0";
        for (const auto& entry : value.items()) {
            const std::string& name = entry.key();
            const auto& member = entry.value();
            json without = all;
            without.at(at).erase(name);
            const bool needed =
                name == "format" || name == "device" || name == "port" || name == "from_m" ||
                name == "to_m" ||
                (registers && name != "largest_left_out_m" && name != "check_point" && name != "tip_m");
            CAPTURE((at / name).to_string());
            CHECK(reads(without) == !needed);
            required(member, at / name);
        }
    };
    required(all, json::json_pointer());
}

}  // namespace station_file_test
