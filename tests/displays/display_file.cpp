// Reading and writing of display files.
#include "content/displays/display_file.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "content/displays/example_displays.hpp"
#include "content/format/embedded.hpp"
#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "tests/displays/support.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/replaced.hpp"

namespace display_file_test {

using namespace bolt;
using namespace bolt::content;
using displays_test::everything;
using displays_test::has;
using displays_test::mistakes;
using test::replaced;

namespace {

DisplayFile read(std::string_view text) {
    LoadedDisplays loaded = parse_displays(text, "d.json");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    return loaded.displays;
}

// The file has exactly one mistake if `to` replaces `from`; its message begins with the line and column where
// `at` begins, and has `part`.
void check_mistake(const std::string& from, const std::string& to, const std::string& at,
                   const std::string& part) {
    const std::string text = replaced(everything(), from, to);
    const std::size_t offset = text.find(at);
    REQUIRE_MESSAGE(offset != std::string::npos, at);
    const std::size_t line_start = text.rfind('\n', offset) + 1;
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n') + 1;
    const std::string place =
        "d.json:" + std::to_string(line) + ":" + std::to_string(offset - line_start + 1) + ": ";
    const std::vector<std::string> found = mistakes(text);
    REQUIRE_MESSAGE(found.size() == 1, (to + ": " + std::to_string(found.size()) + " mistakes, first: " +
                                        (found.empty() ? std::string() : found.front())));
    CHECK_MESSAGE(found.front().starts_with(place), (found.front() + " instead of " + place));
    CHECK_MESSAGE(has(found.front(), part), found.front());
}

// Every member of the schema, with the name of the definition.
std::vector<std::string> schema_members() {
    const auto schema = nlohmann::json::parse(displays_schema_text());
    std::vector<std::string> members;
    for (const auto& [key, value] : schema["properties"].items()) members.push_back(key);
    for (const auto& [name, definition] : schema["definitions"].items())
        if (definition.contains("properties"))
            for (const auto& [key, value] : definition["properties"].items()) members.push_back(key);
    return members;
}

}  // namespace

TEST_CASE("Displays: all members are read") {
    const DisplayFile file = read(everything());
    CHECK(file.schema == "displays.schema.json");
    CHECK(file.name == "Room 4");
    CHECK(file.eye_separation == 0.061);
    const HeadTracking& head = file.head;
    CHECK(head.tracker == HeadTracker::dtrack);
    CHECK(head.fixed_head.position == Vec3(0.1, 1.7, 0.2));
    CHECK(head.fixed_head.orientation == Quat(0.6, 0.0, 0.8, 0.0));
    CHECK(head.port == 5001);
    CHECK(head.body == 3);
    REQUIRE(head.flystick);
    CHECK(head.flystick->id == 2);
    CHECK(head.flystick->aim_in_body.position == Vec3(0.0, 0.01, -0.1));
    CHECK(head.flystick->select == 4);
    CHECK(head.flystick->menu == 1);
    CHECK(head.flystick->tool == 0);
    CHECK(head.pose == TrackedPose::right_hand);
    CHECK(head.recording == "walk.csv");
    CHECK(head.axes == std::array<TrackerAxis, 3>{{{0, false}, {2, false}, {1, true}}});
    CHECK(head.scale == 0.5);
    CHECK(head.tracker_in_room.position == Vec3(0.0, 0.0, 1.0));
    CHECK(head.head_in_body.position == Vec3(0.0, -0.06, 0.02));
    CHECK(head.head_in_body.orientation == Quat(0.0, 1.0, 0.0, 0.0));
    CHECK(head.hold == 0.25);
    CHECK(head.fade == 1.5);
    CHECK(head.max_speed == 3.0);
    CHECK(head.jump_time == 0.2);
    REQUIRE(file.walls.size() == 2);
    const Wall &front = file.walls[0], &left = file.walls[1];
    CHECK(front.name == "front");
    CHECK(front.lower_left == Vec3(-1.5, 0.0, -1.5));
    CHECK(front.lower_right == Vec3(1.5, 0.0, -1.5));
    CHECK(front.upper_right == Vec3(1.5, 2.4, -1.5));
    CHECK(front.stereo == StereoMode::two_outputs);
    CHECK(front.swap_eyes);
    CHECK(front.output.monitor == "DP-1");
    REQUIRE(front.right_output);
    CHECK(front.right_output->monitor_index == 1);
    CHECK(front.right_output->resolution == PixelSize{1500, 1200});
    CHECK(left.stereo == StereoMode::side_by_side);
    CHECK_FALSE(left.swap_eyes);
    CHECK_FALSE(left.right_output);
    CHECK(left.output.position == PixelPosition{0, -20});
    CHECK(left.output.display == ":0.1");
    CHECK(left.output.process == 2);
}

TEST_CASE("Displays: the file of these tests has every member of the schema") {
    for (const std::string& member : schema_members())
        CHECK_MESSAGE(has(everything(), "\"" + member + "\""), member);
}

TEST_CASE("Displays: a file without a head has a fixed one at eye level") {
    const DisplayFile file = read(R"({"format": "boltwright displays 1", "walls": [{"name": "w",
        "lower_left_m": [0, 0, 0], "lower_right_m": [1, 0, 0], "upper_right_m": [1, 1, 0],
        "output": {"monitor_index": 0}}]})");
    CHECK(file.head == HeadTracking{});
    CHECK(file.head.fixed_head.position.y == 1.6);
    CHECK(file.eye_separation == 0.065);
    CHECK(file.walls.front().stereo == StereoMode::mono);
}

TEST_CASE("Displays: the axes of a tracker turn its vectors into the room") {
    const DisplayFile file = read(everything());  // +x, +z, -y: a tracker whose z is up
    const Quat turn = orientation_of(file.head.axes);
    CHECK(glm::length(turn * Vec3(1, 0, 0) - Vec3(1, 0, 0)) < 1e-12);
    CHECK(glm::length(turn * Vec3(0, 0, 1) - Vec3(0, 1, 0)) < 1e-12);
    CHECK(glm::length(turn * Vec3(0, 1, 0) - Vec3(0, 0, -1)) < 1e-12);
}

TEST_CASE("Displays: a file is written and read to the same value") {
    std::vector<DisplayFile> files{read(everything())};
    for (const DisplayKind kind : {DisplayKind::wall, DisplayKind::cave, DisplayKind::desk})
        for (const StereoMode stereo :
             {StereoMode::mono, StereoMode::side_by_side, StereoMode::top_bottom, StereoMode::two_outputs})
            files.push_back(example_displays(kind, stereo));
    Random random(7);
    for (int i = 0; i < 20; ++i) {  // any coordinates survive
        DisplayFile file = files[1];
        file.walls.front().lower_left = Vec3(random.uniform(), random.uniform() / 3.0, -random.uniform());
        file.head.head_in_body.orientation = rotation(Vec3(random.uniform(), random.uniform(), 0.1));
        file.head.hold = random.uniform();
        files.push_back(file);
    }
    for (const DisplayFile& file : files) {
        CAPTURE(displays_json(file));
        CHECK(read(displays_json(file)) == file);
    }
}

TEST_CASE("Displays: lists of numbers are written in one line, and texts with any characters survive") {
    DisplayFile file = example_displays(DisplayKind::desk);
    file.walls[0].name = "a \"b\" [c,\n d] \\";
    file.head.tracker = HeadTracker::file;
    file.head.recording = "[x\\\"] ,{";
    const std::string text = displays_json(file);
    CHECK_MESSAGE(has(text, "\"lower_left_m\": [-0.72, 0.75, -0.3],"), text);
    CHECK(has(text, "\"axes\": [\"+x\", \"+y\", \"+z\"],"));
    CHECK(std::count(text.begin(), text.end(), '\n') < 60);
    CHECK(read(text) == file);
}

TEST_CASE("Displays: every kind of mistake has its line, column, and what is expected") {
    check_mistake("\"format\": \"boltwright displays 1\"", "\"format\": \"boltwright displays 2\"",
                  "\"boltwright displays 2\"", "\"boltwright displays 1\"");
    check_mistake("0.061", "0.5", "0.5", "a number >= 0 and <= 0.1 (m)");
    check_mistake("0.061", "\"wide\"", "\"wide\"", "a number");
    check_mistake("\"body\"", "\"bodi\"", "\"bodi\"", "did you mean \"body\"?");
    check_mistake("\"dtrack\"", "\"dtrac\"", "\"dtrac\"", "did you mean \"dtrack\"?");
    check_mistake("5001", "70000", "70000", "a whole number >= 1 and <= 65535");
    check_mistake("5001", "5001.5", "5001.5", "is not a whole number");
    check_mistake("[0.6, 0, 0.8, 0]", "[0.6, 0, 0.7, 0]", "[0.6, 0, 0.7, 0]",
                  "the quaternion has the length 0.92");
    check_mistake("[0.6, 0, 0.8, 0]", "[1, 0, 0]", "[1, 0, 0]", "4");
    check_mistake("\"+z\"", "\"z\"", "\"z\"", "one of +x, -x, +y");
    check_mistake("\"+z\"", "\"+x\"", "[\"+x\", \"+x\"", "an axis is named twice");
    check_mistake("\"-y\"", "\"+y\"", "[\"+x\"", "these axes mirror the room");
    check_mistake("\"walls\": [", "\"walls\": [ 9,", "9,", "an object");
    check_mistake("[-1.5, 0, -1.5]", "[-1.5, 0]", "[-1.5, 0]", "3");
    check_mistake("[-1.5, 0, -1.5]", "[-1.5, 0, \"a\"]", "\"a\"", "a number");
    check_mistake("[-1.5, 0, -1.5]", "[-1.5, 0, 2000]", "2000", "<= 1000");
    check_mistake("\"side_by_side\"", "\"side-by-side\"", "\"side-by-side\"",
                  "did you mean \"side_by_side\"?");
    check_mistake("\"name\": \"left\"", "\"name\": \"front\"", "\"front\", \"lower_left_m\": [-1.5, 0, 1.5]",
                  "there is another wall \"front\"");
    check_mistake("[0, -20], \"resolution_px\": [1500, 1200]", "[0, -20]", "{ \"position_px\"",
                  "a window has no size");
    check_mistake("[0, -20], \"resolution_px\": [1500, 1200]", "[0, -20], \"resolution_px\": [1500, 8]", "8]",
                  ">= 16");
    check_mistake("{ \"monitor\": \"DP-1\" }", "{ \"monitor\": \"DP-1\", \"monitor_index\": 0 }",
                  "{ \"monitor\": \"DP-1\", ", "the output has more than one place");
    check_mistake("{ \"monitor\": \"DP-1\" }", "{}", "{}", "the output has no place");
    check_mistake("      \"left_output\": { \"monitor\": \"DP-1\" },\n", "", "{ \"name\": \"front\"",
                  "\"left_output\" is missing");
    check_mistake("\"output\": { \"position_px\"",
                  "\"left_output\": { \"monitor_index\": 0 },\n\"output\": { \"position_px\"",
                  "\"left_output\": { \"monitor_index\": 0 }",
                  "has no meaning with the stereo mode \"side_by_side\"");
    check_mistake("\"menu\": 1", "\"menu\": 4", "{ \"id\": 2", "a button has two functions");
    check_mistake("\"menu\": 1", "\"menu\": 33", "33", "<= 32");
    check_mistake("\"tracker\": \"dtrack\"", "\"tracker\": \"openxr\"", "\"flystick\"",
                  "the tracker \"openxr\" has no flystick");
    check_mistake("\"tracker\": \"dtrack\",", "\"tracker\": \"dtrack\", \"recordin\": 0,", "\"recordin\"",
                  "did you mean \"recording\"?");
}

TEST_CASE("Displays: a tracker \"file\" needs a recording") {
    const std::string text =
        replaced(replaced(everything(), "\"dtrack\"", "\"file\""), "    \"recording\": \"walk.csv\",\n", "");
    const std::vector<std::string> found = mistakes(text);
    REQUIRE(found.size() == 2);  // and the flystick
    CHECK(has(found.front(), "d.json:6:11: /head: the tracker \"file\" has no \"recording\""));
}

TEST_CASE("Displays: several mistakes are reported at once, in the order of the file") {
    std::string text = replaced(everything(), "0.061", "7");
    text = replaced(text, "5001", "\"five\"");
    text = replaced(text, "[1500, 1200] } },", "[1500] } },");
    const std::vector<std::string> found = mistakes(text);
    REQUIRE(found.size() == 3);
    CHECK(has(found[0], "d.json:5:"));
    CHECK(has(found[1], "d.json:9:"));
    CHECK(has(found[2], "d.json:25:"));
}

TEST_CASE("Displays: bytes that are no display file are errors with a position") {
    for (const char* text : {"", "[", "{", "null", "{}", "{\"format\": \"boltwright displays 1\"}", "\xff",
                             R"({"format": "boltwright displays 1", "walls": []})"})
        CHECK_MESSAGE(!mistakes(text).empty(), text);
    const LoadedDisplays missing = load_displays("/nonexistent/d.json");
    REQUIRE(missing.errors.size() == 1);
    CHECK(has(missing.errors.front().message(), "/nonexistent/d.json"));
}

TEST_CASE("Displays: the position of each wall is kept for later checks") {
    const LoadedDisplays loaded = parse_displays(everything(), "d.json");
    REQUIRE(loaded.wall_positions.size() == 2);
    CHECK(loaded.wall_positions[0].line == 22);
    CHECK(loaded.wall_positions[0].column == 5);
    CHECK(loaded.wall_positions[1].line == 26);
    const std::vector<DisplayFinding> findings{{true, "crosses", 1}, {false, "is odd", {}}};
    CHECK(describe(findings, loaded) == "d.json:26:5: crosses\nd.json: warning: is odd\n");
}

TEST_CASE("Displays: a value that a reader would refuse is not saved") {
    const test::Folder folder;
    DisplayFile file = example_displays(DisplayKind::cave);
    REQUIRE(save_displays(folder / "cave.json", file));
    const std::string before = *read_file(folder / "cave.json", 1U << 20U, ErrorCode::failed);
    file.walls[1].name = file.walls[0].name;
    const Status refused = save_displays(folder / "cave.json", file);
    REQUIRE_FALSE(refused);
    CHECK(has(refused.error().message(), "there is another wall"));
    CHECK(*read_file(folder / "cave.json", 1U << 20U, ErrorCode::failed) == before);
    CHECK(load_displays(folder / "cave.json").displays == example_displays(DisplayKind::cave));
}

}  // namespace display_file_test
