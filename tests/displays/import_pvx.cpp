// Import of ParaView's .pvx files.
#include "content/displays/import_pvx.hpp"

#include <doctest/doctest.h>

#include "content/displays/check_displays.hpp"
#include "engine/base/file.hpp"
#include "tests/displays/support.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/replaced.hpp"

namespace import_pvx_test {

using namespace bolt;
using namespace bolt::content;
using displays_test::has;
using displays_test::texts;
using test::replaced;

namespace {

// Three walls of one computer, in the form of ParaView's documentation.
const std::string cave = R"(<?xml version="1.0" ?>
<pvx>
  <!-- the lab -->
  <Process Type="client" />
  <Process Type="server">
    <EyeSeparation Value="0.065"/>
    <UseOffAxisProjection Value="1"/>
    <Machine Name="left" Environment="DISPLAY=:0" Geometry="1024x768+0+0"
             LowerLeft="-1 0 1" LowerRight="-1 0 -1" UpperRight="-1 1.5 -1"/>
    <Machine Name="front" Environment="DISPLAY=:0" Geometry="1024x768+1024+0"
             LowerLeft="-1.0 0.0 -1.0" LowerRight=" 1.0 0.0 -1.0" UpperRight=" 1.0 1.5 -1.0"/>
    <Machine Name="right" Environment="DISPLAY=:0" Geometry="1024x768+2048+0"
             LowerLeft="1, 0, -1" LowerRight="1, 0, 1" UpperRight="1, 1.5, 1"/>
  </Process>
</pvx>
)";

std::string machine(const std::string& attributes) {
    return "<Machine LowerLeft=\"-1 0 -1\" LowerRight=\"1 0 -1\" UpperRight=\"1 1.5 -1\" " + attributes +
           "/>\n";
}
std::string file_of(const std::string& machines) { return "<pvx>\n" + machines + "</pvx>\n"; }

ImportedDisplays imported(const std::string& text, double scale = 1.0,
                          std::optional<double> eye_height = std::nullopt) {
    ImportedDisplays result = import_pvx(text, "c.pvx", {scale, eye_height});
    for (const Error& error : result.errors) FAIL_CHECK(error.message());
    // An imported file can be written and read.
    const LoadedDisplays again = parse_displays(displays_json(result.displays), "d.json");
    for (const Error& error : again.errors) FAIL_CHECK(error.message());
    CHECK(again.displays == result.displays);
    return result;
}

bool warns(const ImportedDisplays& result, const std::string& part) {
    for (const Error& warning : result.warnings)
        if (has(warning.message(), part)) return true;
    return false;
}

// Exactly one error, with this message.
void check_error(const std::string& text, const std::string& message) {
    const ImportedDisplays result = import_pvx(text, "c.pvx");
    REQUIRE_MESSAGE(result.errors.size() == 1, message);
    CHECK_MESSAGE(has(result.errors.front().message(), message), result.errors.front().message());
    CHECK(result.errors.front().code == ErrorCode::bad_content);
    CHECK(result.displays == DisplayFile{});
}

}  // namespace

TEST_CASE(".pvx: walls, windows and the eye separation are imported") {
    const ImportedDisplays result = imported(cave);
    const DisplayFile& file = result.displays;
    REQUIRE(file.walls.size() == 3);
    CHECK(file.walls[0].name == "left");
    CHECK(file.walls[0].lower_left == Vec3(-1, 0, 1));
    CHECK(file.walls[1].lower_right == Vec3(1, 0, -1));
    CHECK(file.walls[2].upper_right == Vec3(1, 1.5, 1));
    CHECK(file.walls[1].output.position == PixelPosition{1024, 0});
    CHECK(file.walls[1].output.resolution == PixelSize{1024, 768});
    CHECK(file.walls[1].output.process == 0);
    CHECK(file.walls[1].output.display.empty());
    CHECK(file.eye_separation == 0.065);
    const auto found = texts(check_displays(file));
    REQUIRE(found.size() == 2);
    CHECK(has(found[0], "the fixed head, 1.60 m high, is above all walls, which end at 1.50 m"));
    CHECK(has(found[1], "dmm"));  // the panel is far below the eyes
    REQUIRE(result.warnings.size() == 1);
    CHECK(has(result.warnings[0].message(),
              "c.pvx:8:6: the file does not have the viewer and its tracker: enter them; until then the head "
              "is fixed at 0.00, 1.60, 0.00 m"));
}

TEST_CASE(".pvx: the Process of the server is used, and another one that is not empty is named") {
    const ImportedDisplays result = imported(
        replaced(cave, "<Process Type=\"client\" />", "<Process Type=\"client\"><Machine/></Process>"));
    CHECK(result.displays.walls.size() == 3);
    CHECK(warns(result, "c.pvx:4:4: another Process is used; this one is left out"));
}

TEST_CASE(".pvx: old files without a Process, and other units") {
    const ImportedDisplays result =
        imported(file_of("<EyeSeparation Value=\"6.5\"/>" + machine("Geometry=\"800x600+0+0\"")), 0.01);
    CHECK(result.displays.walls.at(0).name == "wall");
    CHECK(result.displays.walls.at(0).lower_right == Vec3(0.01, 0.0, -0.01));
    CHECK(result.displays.eye_separation == doctest::Approx(0.065));
}

TEST_CASE(".pvx: stereo types become modes, and two machines with the same corners two outputs") {
    const std::string left = machine("Name=\"l\" StereoType=\"Left\" Geometry=\"800x600+0+0\""),
                      right = machine("Name=\"r\" StereoType=\"Right\" Geometry=\"800x600+800+0\"");
    for (const std::string& text : {file_of(left + right), file_of(right + left)}) {
        const ImportedDisplays result = imported(text);
        REQUIRE(result.displays.walls.size() == 1);
        const Wall& wall = result.displays.walls[0];
        CHECK(wall.name == "l");
        CHECK(wall.stereo == StereoMode::two_outputs);
        CHECK(wall.output.position == PixelPosition{0, 0});
        REQUIRE(wall.right_output);
        CHECK(wall.right_output->position == PixelPosition{800, 0});
    }
    const auto stereo_of = [](const std::string& type) {
        return imported(file_of(machine("Geometry=\"800x600+0+0\" StereoType=\"" + type + "\"")));
    };
    CHECK(stereo_of("SplitViewportHorizontal").displays.walls[0].stereo == StereoMode::side_by_side);
    CHECK(stereo_of("Mono").displays.walls[0].stereo == StereoMode::mono);
    const ImportedDisplays anaglyph = stereo_of("Anaglyph"), alone = stereo_of("Left");
    CHECK(anaglyph.displays.walls[0].stereo == StereoMode::mono);
    CHECK(warns(anaglyph, "c.pvx:2:"));
    CHECK(warns(anaglyph, "the StereoType \"Anaglyph\" has no counterpart: the wall is mono"));
    CHECK(warns(alone, "no machine has the same corners and the StereoType \"Right\": the wall is mono"));
}

TEST_CASE(".pvx: names are computers only if their windows are at the same place") {
    const std::string a = machine("Name=\"a\" Geometry=\"800x600+0+0\""),
                      b = machine("Name=\"b\" Geometry=\"800x600+0+0\""),
                      beside = machine("Name=\"b\" Geometry=\"800x600+800+0\"");
    const ImportedDisplays two = imported(file_of(a + b));
    CHECK(two.displays.walls[0].output.process == 0);
    CHECK(two.displays.walls[1].output.process == 1);
    CHECK(warns(two, "so each Name is taken as a computer with a process of its own: 2 processes"));
    const ImportedDisplays one = imported(file_of(a + beside));
    CHECK(one.displays.walls[1].output.process == 0);
    CHECK_FALSE(warns(one, "processes"));
    // Windows of one Name get walls with names of their own.
    const ImportedDisplays same = imported(file_of(a + a));
    CHECK(same.displays.walls[1].name == "a 2");
    CHECK(same.displays.walls[1].output.process == 0);
    // Without a Geometry each fills the screen of its computer, or of its X display.
    const ImportedDisplays full = imported(file_of(machine("Name=\"a\"") + machine("Name=\"b\"")));
    CHECK(full.displays.walls[1].output.process == 1);
    CHECK(full.displays.walls[1].output.monitor_index == 0);
    CHECK(warns(full, "without a Geometry the wall fills a monitor"));
    const ImportedDisplays displays =
        imported(file_of(machine("Name=\"a\" Environment=\"DISPLAY=:0.0\"") +
                         machine("Name=\"a\" Environment=\"DISPLAY=:0.1;X=1\"")));
    CHECK(displays.displays.walls[1].output.display == ":0.1");
    CHECK(warns(displays, "\"X=1\" of Environment is left out"));
}

TEST_CASE(".pvx: the display that all walls have is that of the program") {
    const ImportedDisplays result =
        imported(file_of(machine("Environment=\"DISPLAY=:1\" Geometry=\"800x600+0+0\"")));
    CHECK(result.displays.walls[0].output.display.empty());
    CHECK(warns(result, "all walls are on the display \":1\": start the program there"));
}

TEST_CASE(".pvx: the head is placed where all walls are seen from the front") {
    const ImportedDisplays origin =
        imported(file_of("<Machine LowerLeft=\"-1 -1 -1\" LowerRight=\"1 -1 -1\" UpperRight=\"1 1 -1\" "
                         "Geometry=\"800x800+0+0\"/><Machine LowerLeft=\"-1 1 -1\" LowerRight=\"1 1 -1\" "
                         "UpperRight=\"1 1 1\" Geometry=\"800x800+800+0\"/>"));
    CHECK(origin.displays.head.fixed_head.position == Vec3(0.0));  // 1.6 m would be above the ceiling
    const auto found = texts(check_displays(origin.displays));
    REQUIRE(found.size() == 1);
    CHECK(has(found[0], "its lowest corner is 1.00 m below the floor"));
    const ImportedDisplays away =
        imported(file_of("<Machine LowerLeft=\"-1 0 5\" LowerRight=\"1 0 5\" UpperRight=\"1 2 5\" "
                         "Geometry=\"800x800+0+0\"/>"));
    CHECK(away.displays.head.fixed_head.position == Vec3(0.0, 1.0, 6.0));
}

TEST_CASE(".pvx: an origin between the viewer's eyes is placed at their height") {
    const std::string eyes_at_origin = file_of(
        "<Machine LowerLeft=\"-1.5 -1 -1\" LowerRight=\"1.5 -1 -1\" UpperRight=\"1.5 1 -1\" "
        "Geometry=\"1200x800+0+0\"/>");
    const auto found = texts(check_displays(imported(eyes_at_origin).displays));
    REQUIRE(found.size() == 3);
    CHECK(has(found[0], "below the floor"));
    CHECK(has(found[1], "above all walls"));
    CHECK(has(found[2], "dmm"));  // far below the eyes
    const ImportedDisplays raised = imported(eyes_at_origin, 1.0, 1.2);
    CHECK(raised.displays.head.fixed_head.position == Vec3(0.0, 1.2, 0.0));
    CHECK(raised.displays.walls[0].lower_left == Vec3(-1.5, -1.0 + 1.2, -1.0));
    CHECK(raised.displays.walls[0].upper_right == Vec3(1.5, 1.0 + 1.2, -1.0));
    CHECK(check_displays(raised.displays).empty());
}

TEST_CASE(".pvx: attributes and elements without a counterpart are named") {
    const ImportedDisplays result = imported(file_of(
        "<Option Name=\"--mpi\"/><Unknown/><UseOffAxisProjection Value=\"0\"/>" +
        machine("Geometry=\"800x600+0+0\" FullScreen=\"1\" ShowBorders=\"0\" ViewerId=\"2\" Foo=\"7\"")));
    CHECK(warns(result, "the option \"--mpi\" is left out"));
    CHECK(warns(result, "the element \"Unknown\" is not known and left out"));
    CHECK(warns(result, "UseOffAxisProjection is off"));
    CHECK(warns(result, "FullScreen \"1\" is left out: the window stays at its Geometry"));
    CHECK(warns(result, "ViewerId \"2\" is left out"));
    CHECK(warns(result, "the attribute \"Foo\" is not known and left out"));
    CHECK_FALSE(warns(result, "ShowBorders"));
}

TEST_CASE(".pvx: errors name the line, the column and what is expected") {
    check_error(replaced(cave, "LowerLeft=\"-1 0 1\" ", ""),
                "c.pvx:8:6: LowerLeft is missing; expected a corner");
    check_error(replaced(cave, "\"-1 0 1\"", "\"-1 0\""),
                "c.pvx:9:14: LowerLeft cannot be \"-1 0\"; expected three numbers of at most 1000 m");
    check_error(replaced(cave, "\"-1 0 1\"", "\"-1 0 nan\""), "c.pvx:9:14: LowerLeft cannot be");
    check_error(replaced(cave, "\"-1 0 1\"", "\"-1 0 1m\""), "c.pvx:9:14: LowerLeft cannot be");
    check_error(replaced(cave, "\"-1 0 1\"", "\"-1500 0 1\""), "other units need another scale");
    for (const char* geometry : {"1024x768", "1024x768+0", "0x768+0+0", "1024x768+0+0+0", "axb+0+0",
                                 "99999999999x768+0+0", "1024*768+0+0"})
        check_error(replaced(cave, "1024x768+0+0", geometry), "c.pvx:8:51: Geometry cannot be");
    check_error(replaced(cave, "\"0.065\"", "\"6.5\""), "c.pvx:6:20: the eye separation cannot be \"6.5\"");
    check_error(replaced(cave, "\"0.065\"", "\"\""), "c.pvx:6:20: the eye separation cannot be \"\"");
    check_error(
        replaced(cave, "<UseOffAxisProjection Value=\"1\"/>", "<UseOffAxisProjection Value=\"maybe\"/>"),
        "c.pvx:7:27: \"maybe\" is not a truth value; expected 0 or 1");
    check_error(replaced(cave, "Name=\"left\"", "Name=\"" + std::string(300, 'x') + "\""),
                "the Name is too long");
    check_error(file_of(""), "c.pvx:1:2: there is no Machine; expected a Machine for each wall");
    check_error("<cave/>", "c.pvx:1:1: the file has no element pvx; expected a file of ParaView");
    check_error("{}", "c.pvx:1:3: this is not XML");
    check_error("", "this is not XML");
    check_error(replaced(cave, "</Process>\n</pvx>", "</pvx>"), "this is not XML");
    check_error(replaced(cave, "the lab", "the \xff lab"), "c.pvx:3:12: ");
    std::string many;
    for (int i = 0; i < 40; ++i) many += machine("");
    check_error(file_of(many), "c.pvx:34:2: there are too many machines; expected at most 32");
}

TEST_CASE(".pvx: the number of messages is bounded") {
    std::string text = file_of(machine(""));
    for (int i = 0; i < 1000; ++i) text = replaced(text, "<pvx>", "<pvx><X/>");
    const ImportedDisplays result = import_pvx(text, "c.pvx");
    CHECK(result.warnings.size() == 201);
    bool bounded = false;
    for (const Error& warning : result.warnings)
        bounded |= has(warning.what, "further messages are not shown");
    CHECK(bounded);
}

TEST_CASE(".pvx: a file is loaded, and a missing one is an error") {
    const test::Folder folder;
    REQUIRE(write_file(folder / "c.pvx", cave));
    CHECK(load_pvx(folder / "c.pvx").displays == import_pvx(cave, "c.pvx").displays);
    const ImportedDisplays missing = load_pvx(folder / "none.pvx");
    REQUIRE(missing.errors.size() == 1);
    CHECK(has(missing.errors.front().message(), "none.pvx"));
}

}  // namespace import_pvx_test
