// Reading of a rig's description, and the mistakes that the reader reports.
#include "game/measure/rig.hpp"

#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "engine/base/math.hpp"
#include "tests/measure/support.hpp"
#include "tests/support/replaced.hpp"

namespace rig_test {

using namespace measure_test;
using test::replaced;

namespace {

std::string first_mistake(const std::string& from, const std::string& to) {
    const measure::LoadedRig loaded = measure::parse_rig(replaced(force_rig, from, to), "rig.json");
    return loaded.ok() ? "no mistake" : loaded.errors.front().message();
}

void check_mistake(const std::string& from, const std::string& to, std::string_view begin,
                   std::string_view part) {
    const std::string message = first_mistake(from, to);
    CHECK_MESSAGE(message.starts_with(begin), message);
    CHECK_MESSAGE(message.find(part) != std::string::npos, message);
}

}  // namespace

TEST_CASE("Rig: members are read in SI units; expanded uncertainties become standard ones") {
    const measure::Rig rig = parsed_rig(force_rig);
    CHECK(rig.time.unit == 1e-3);
    CHECK(rig.torque.lever == doctest::Approx(0.25));
    CHECK(rig.torque.lever_uncertainty == doctest::Approx(0.001));
    CHECK(rig.torque.channel.uncertainty == doctest::Approx(0.2));
    CHECK(rig.torque.channel.relative_uncertainty == doctest::Approx(0.005));
    CHECK(rig.torque.channel.value(3.0) == doctest::Approx(5.0));
    CHECK(rig.angle.channel.resolution == doctest::Approx(to_radians(0.1)));
    CHECK(rig.angle.kind == measure::AngleKind::column);
}

TEST_CASE("Rig: units in the names of columns") {
    using measure::unit_in_name;
    CHECK(unit_in_name("Torque [Nm]") == "N.m");
    CHECK(unit_in_name("Torque [N.mm] ") == "N.mm");
    CHECK(unit_in_name("Fx (kN)") == "kN");
    CHECK(unit_in_name("angle_deg") == "deg");
    CHECK(unit_in_name("Winkel [°]") == "deg");
    CHECK(unit_in_name("grip_force") == "");
    CHECK(unit_in_name("Kraft [quux]") == "");
    CHECK(unit_in_name("") == "");
}

TEST_CASE("Rig: mistakes are reported with line and column") {
    check_mistake("\"Fx\", \"unit\": \"N\", \"lever_mm\": 250,", "\"Fx\", \"unit\": \"N\",",
                  "rig.json:9:", "N is a force");
    check_mistake("\"unit\": \"N\"", "\"unit\": \"N.m\"", "rig.json:9:", "N.m is a torque");
    check_mistake("\"unit\": \"N\"", "\"unit\": \"Nm\"", "rig.json:9:29: ", "one of N.m, N.mm");
    check_mistake("\"column\": \"t\", ", "", "rig.json:7:11: ", "neither a column nor a rate");
    check_mistake("\"column\": \"t\"", "\"column\": \"t\", \"rate_Hz\": 5", "rig.json:7:11: ", "both");
    check_mistake("\"column\": \"phi\", ", "", "rig.json:12:12: ", "there is no angle");
    check_mistake("\"column\": \"phi\"", "\"speed_deg_s\": 3, \"column\": \"phi\"",
                  "rig.json:12:12: ", "more than one");
    check_mistake("\"unit\": \"deg\", ", "", "rig.json:12:12: ", "has no unit");
    check_mistake("\"thread\"", "\"property_class\": \"8.9\", \"thread\"",
                  "rig.json:6:21: ", "did you mean \"8.8\"");
    check_mistake("\"M8\"", "\"M9\"", "rig.json:6:13: ", "not a known thread size");
    check_mistake("\"column\": \"phi\", \"unit\": \"deg\", \"resolution\": 0.1",
                  "\"points_s_deg\": [[0, 0], [2, 5], [1, 7]]",
                  "rig.json:12:", "the time 1 s is not after 2 s");
    check_mistake("\"tighten\",", "\"tighten\", \"table\": {\"decimal\": \"comma\"},",
                  "rig.json:5:", "\"semicolon\"");
    check_mistake("these tests", "these\\ntests", "rig.json:4:", "line break");
    check_mistake("\"title\"", "\"titel\"", "rig.json:3:3: ", "title");
    check_mistake("boltwright rig 1", "boltwright rig 9", "rig.json:2:", "boltwright rig 1");
    CHECK_FALSE(measure::parse_rig("{", "rig.json").ok());
    CHECK_FALSE(measure::load_rig("/nowhere/rig.json").ok());
}

}  // namespace rig_test
