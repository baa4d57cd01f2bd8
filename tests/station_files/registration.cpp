#include "content/station/registration.hpp"

#include <doctest/doctest.h>

#include "content/station/station_file.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"

namespace registration_file_test {

using namespace bolt;
using namespace bolt::content;

namespace {

const std::string beginning = R"({"format": "boltwright station 1", "registrations": [)"
                              "\n";
const std::string good =
    R"({"from": "arm", "to": "room", "date": "2026-03-02T09:15:00Z", "position_m": [0, 0, 1], )"
    R"("orientation_wxyz": [0, 1, 0, 0], "points": 5, "rms_m": 0.002, "largest_left_out_m": 0.004})";

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, from);
    return text.replace(at, from.size(), to);
}

// The message for a file with this list, which begins on line 2.
std::string error_of(const std::string& list) {
    const Result<StationFile> station = parse_station(beginning + list + "\n]}", "s.json");
    REQUIRE_MESSAGE(!station, list);
    CHECK(station.error().code == ErrorCode::bad_content);
    return station.error().message();
}

// The message if `to` replaces `from`; it names the column of the value that begins with `at`.
std::string error_at(const std::string& from, const std::string& to, const std::string& at) {
    const std::string text = replaced(from, to);
    const std::string place = "s.json:2:" + std::to_string(text.find(at) + 1) + ": ";
    const std::string message = error_of(text);
    CHECK_MESSAGE(message.find(place) == 0, (message + " instead of " + place));
    return message;
}

bool contains(const std::string& text, const std::string& part) {
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Registration: a file without registrations stays valid, and an empty list is none") {
    const auto old = parse_station(R"({"format": "boltwright station 1"})", "s.json");
    REQUIRE(old);
    CHECK(old->registrations.empty());
    CHECK(station_json(*old).find("registrations") == std::string::npos);
    const auto empty = parse_station(beginning + "]}", "s.json");
    REQUIRE(empty);
    CHECK(*empty == *old);
    const auto one = parse_station(beginning + good + "]}", "s.json");
    REQUIRE_MESSAGE(one, one.error().message());
    CHECK(one->registrations.size() == 1);
}

TEST_CASE("Registration: mistakes are reported with line, column and what is expected") {
    CHECK(contains(error_at("\"arm\"", "\"am\"", "\"am\""), "\"am\" is not a frame; did you mean \"arm\"?"));
    CHECK(contains(error_at("\"room\"", "\"rom\"", "\"rom\""), "did you mean \"room\"?"));
    CHECK(contains(error_at("\"room\"", "\"hall of mirrors\"", "\"hall"), "one of arm, wheel, tracker"));
    CHECK(contains(error_at("\"room\"", "7", "7"), "/registrations/0/to: \"to\" is not a short text"));
    CHECK(contains(error_at("\"room\"", "\"arm\"", "\"arm\", \"date"), "both frames are the same"));
    CHECK(contains(error_at("2026-03-02T", "2026-02-30T", "\"2026-02-30"),
                   "is not a date; expected a date and time in UTC"));
    CHECK(contains(error_at("[0, 0, 1]", "[0, 0]", "[0, 0]"), "is not a list of 3 numbers"));
    CHECK(contains(error_at("[0, 0, 1]", "7", "7"), "is not a list of 3 numbers"));
    CHECK(contains(error_at("[0, 0, 1]", "[0, 0, 1001]", "1001"), "a number from -1000 to 1000"));
    CHECK(contains(error_at("[0, 0, 1]", "[0, \"0\", 1]", "\"0\", 1"), "/registrations/0/position_m/1"));
    CHECK(contains(error_at("[0, 1, 0, 0]", "[0, 1, 0, 0.01]", "[0, 1, 0, 0.01]"),
                   "the quaternion has the length 1.00005; expected a unit quaternion [w, x, y, z]"));
    CHECK(contains(error_at("[0, 1, 0, 0]", "[0, 0, 0, 0]", "[0, 0, 0, 0]"), "has the length 0;"));
    CHECK(contains(error_at("[0, 1, 0, 0]", "[0, 2, 0, 0]", "2, 0, 0]"), "cannot have \"2\""));
    CHECK(contains(error_at("\"points\": 5", "\"points\": 2", "2, \"rms"), "a number from 3 to 1000"));
    CHECK(contains(error_at("\"points\": 5", "\"points\": 5.5", "5.5"), "a whole number from 3 to 1000"));
    CHECK(contains(error_at("0.002", "-0.002", "-0.002"), "a number from 0 to 1"));
    CHECK(contains(error_at("0.004", "0.001", "0.001}"),
                   "a largest residual of 0.001 is impossible with an rms of 0.002; expected a number that "
                   "is not less than \"rms_m\""));
    CHECK(
        contains(error_at("\"points\": 5", "\"points\": 3", "0.004"), "with 3 points none can be left out"));
    CHECK(contains(error_at("\"rms_m\"", "\"rms_n\"", "\"rms_n\""), "did you mean \"rms_m\"?"));
    CHECK(contains(error_at("0.004", "0.004, \"check_point\": 1", "1}"), "is not an object"));
    CHECK(contains(error_at("0.004", "0.004, \"check_point\": {\"from_m\": [0, 0, 0]}", "{\"from_m"),
                   "\"to_m\" is missing"));
    CHECK(contains(error_of("7"), "s.json:2:1: /registrations/0: the registration is not an object"));
    CHECK(parse_station(R"({"format": "boltwright station 1", "registrations": {}})", "s")
              .error()
              .message()
              .find("s:1:53: /registrations: \"registrations\" is not a list") == 0);
    std::string many = good;
    for (int i = 0; i < 64; ++i) many += "," + good;
    CHECK(contains(error_of(many), "is not a list of at most 64"));
}

TEST_CASE("Registration: two registrations between the same frames are an error, in either direction") {
    const std::string reversed = replaced(R"("from": "arm", "to": "room")", R"("from": "room", "to": "arm")");
    for (const std::string& second : {good, reversed}) {
        const std::string message = error_of(good + ",\n" + second);
        CHECK(message.find("s.json:3:1: /registrations/1: there are two registrations between ") == 0);
    }
    const std::string other = replaced("\"arm\"", "\"tracker\"");
    CHECK(parse_station(beginning + good + "," + other + "]}", "s").has_value());
}

TEST_CASE("Registration: a new one replaces that between the same frames, and no other") {
    std::vector<Registration> all;
    const auto add = [&](CoordinateFrame from, CoordinateFrame to, int points) {
        Registration one;
        one.from = from;
        one.to = to;
        one.points = points;
        set_registration(all, one);
    };
    add(CoordinateFrame::arm, CoordinateFrame::room, 4);
    add(CoordinateFrame::tracker, CoordinateFrame::room, 5);
    add(CoordinateFrame::room, CoordinateFrame::arm, 6);
    REQUIRE(all.size() == 2);
    CHECK(all[0].points == 6);
    CHECK(all[0].from == CoordinateFrame::room);
    CHECK(all[1].points == 5);
    CHECK(find_registration(all, CoordinateFrame::arm, CoordinateFrame::room) == all.data());
    CHECK(find_registration(all, CoordinateFrame::arm, CoordinateFrame::tracker) == nullptr);
}

TEST_CASE("Registration: dates are checked by the calendar") {
    for (const char* date : {"2026-03-02T09:15:00Z", "2024-02-29T23:59:59Z", "1999-12-31T00:00:00Z"})
        CHECK(is_utc_date(date));
    for (const char* date :
         {"", "2026-03-02", "2026-03-02T09:15:00", "2026-03-02 09:15:00Z", "2026-13-02T09:15:00Z",
          "2026-00-02T09:15:00Z", "2025-02-29T09:15:00Z", "2026-03-02T24:15:00Z", "2026-03-02T09:60:00Z",
          "2026-03-02T09:15:60Z", "2026-03-0-T09:15:00Z", "2026-03-02T09:15:00ZZ", "+026-03-02T09:15:00Z"})
        CHECK_MESSAGE(!is_utc_date(date), date);
}

TEST_CASE("Registration: the error of the check point follows from the pose") {
    Registration one;
    CHECK(!check_error(one));
    one.pose = {{1.0, 0.0, 0.0}, rotation({0.0, 0.0, pi / 2})};
    one.check_point = PointPair{{1.0, 0.0, 0.0}, {1.0, 1.003, 0.004}};
    CHECK(*check_error(one) == doctest::Approx(0.005).epsilon(1e-9));
}

TEST_CASE("Registration: what an alignment gives is always accepted by the reader") {
    Random random(12);
    for (int trial = 0; trial < 2000; ++trial) {
        const Pose pose{{random.uniform(-3, 3), random.uniform(-3, 3), 0.0}, random_turn(random)};
        std::vector<PointPair> pairs;
        for (int i = 0; i < 4 + trial % 6; ++i) {
            const Vec3 from(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
            pairs.push_back({from, pose * from + 1e-3 * (trial % 3) * random_direction(random)});
        }
        const Result<RigidAlignment> aligned = align_points(pairs, any_scale_limits);
        if (!aligned) continue;
        Registration one;
        one.date = "2026-03-02T09:15:00Z";
        one.pose = aligned->pose;
        one.points = static_cast<int>(pairs.size());
        one.rms = aligned->rms;
        one.largest_left_out = largest_residual(leave_one_out_residuals(pairs));
        StationFile station;
        station.registrations.push_back(one);
        const auto again = parse_station(station_json(station), "s.json");
        REQUIRE_MESSAGE(again, (again ? "" : again.error().message()));
        REQUIRE(*again == station);
    }
}

}  // namespace registration_file_test
