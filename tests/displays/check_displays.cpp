// Checks of walls and outputs that go beyond the form of the file.
#include "content/displays/check_displays.hpp"

#include <doctest/doctest.h>

#include "content/displays/example_displays.hpp"
#include "tests/displays/support.hpp"

namespace check_displays_test {

using namespace bolt;
using namespace bolt::content;
using namespace displays_test;

namespace {

// Exactly one finding of the file, with this part.
void check_one(const DisplayFile& displays, const std::string& part, const DisplayHost& host = {}) {
    const auto found = texts(check_displays(displays, host));
    REQUIRE_MESSAGE(found.size() == 1, part);
    CHECK_MESSAGE(has(found.front(), part), found.front());
}

DisplayFile on_monitor(const std::string& name) {
    DisplayFile file = with_walls({front_wall()});
    file.walls.front().output = {};
    file.walls.front().output.monitor = name;
    return file;
}

const DisplayHost two_monitors{{{"DP-1", 0, 0, 1500, 1200}, {"DP-2", 1500, 0, 1920, 1080}}, 0, ":0"};

}  // namespace

TEST_CASE("Display check: the examples have no findings, in every stereo mode") {
    for (const DisplayKind kind : {DisplayKind::wall, DisplayKind::cave, DisplayKind::desk})
        for (const StereoMode stereo :
             {StereoMode::mono, StereoMode::side_by_side, StereoMode::top_bottom, StereoMode::two_outputs}) {
            const auto found = texts(check_displays(example_displays(kind, stereo)));
            CHECK_MESSAGE(found.empty(), found.front());
        }
}

TEST_CASE("Display check: corners must make a rectangle of plausible size") {
    DisplayFile file = with_walls({front_wall()});
    file.walls[0].upper_right.x += 0.1;  // atan(0.1 / 2.4): 92.39 degrees
    check_one(file,
              "wall \"front\": its angle at the lower right corner is 92.39 degrees; expected 90 to 0.5");
    file = with_walls({front_wall()});
    file.walls[0].upper_right.x += 0.01;  // 0.24 degrees
    CHECK(check_displays(file).empty());
    file.walls[0].upper_right = file.walls[0].lower_right;
    check_one(file, "is 3 m wide and 0 m high; expected at least 0.05 m each: are two corners the same?");
    file = with_walls({front_wall()});
    file.head.fixed_head.position = {0.0, 1600.0, 0.0};
    for (Vec3* corner : {&file.walls[0].lower_left, &file.walls[0].lower_right, &file.walls[0].upper_right})
        *corner *= 100.0;
    check_one(file,
              "warning: wall \"front\": it is 300 m wide and 240 m high; expected at most 100 m: are its "
              "corners in metres?");
}

TEST_CASE("Display check: the head must be in front of each wall") {
    DisplayFile file = with_walls({front_wall()});
    std::swap(file.walls[0].lower_left, file.walls[0].lower_right);
    file.walls[0].upper_right.x = -1.5;
    check_one(file,
              "the fixed head (0, 1.6, 0) m is 1.5 m behind it; expected it in front: are its left and right "
              "corners exchanged?");
    file = with_walls({front_wall()});
    file.head.fixed_head.position.z = -1.48;
    check_one(file, "the fixed head (0, 1.6, -1.48) m is 0.02 m in front of it; expected at least 0.05 m");
    file = with_walls({front_wall()});
    file.walls[0].lower_left = {1.5, 2.4, -1.5};
    file.walls[0].lower_right = {-1.5, 2.4, -1.5};
    file.walls[0].upper_right = {-1.5, 0.0, -1.5};
    check_one(file, "warning: wall \"front\": its upper corner is below its lower corners");
}

TEST_CASE("Display check: walls that cross, overlap or nearly meet are found") {
    DisplayFile file = with_walls({front_wall(), moved(turned_wall("left", 90.0), {0.3, 0.0, -0.3})});
    check_one(file, "walls \"front\" and \"left\" cross; expected walls that meet at their edges");
    CHECK(check_displays(file).front().prevents_use);
    CHECK(check_displays(file).front().wall == 1);
    check_one(with_walls({front_wall(), moved(turned_wall("left", 90.0), {0.2, 0.0, 0.0})}),
              "warning: wall \"left\" ends 200 mm inside wall \"front\": what is behind it cannot be seen");
    check_one(with_walls({front_wall(), moved(front_wall("right"), {2.9, 0.0, 0.0})}),
              "warning: walls \"front\" and \"right\" overlap by 100.0 mm: their pictures are not blended");
    check_one(with_walls({front_wall(), moved(front_wall("right"), {3.012, 0.0, 0.0})}),
              "warning: walls \"front\" and \"right\" nearly meet: the gap is up to 12.0 mm");
    CHECK(check_displays(with_walls({front_wall(), moved(front_wall("right"), {3.2, 0.0, 0.0})})).empty());
}

TEST_CASE("Display check: a name is used once, and the eyes are as far apart as people's") {
    check_one(with_walls({front_wall(), moved(front_wall(), {3.0, 0.0, 0.0})}),
              "walls 1 and 2 are both named \"front\"");
    DisplayFile file = with_walls({front_wall()});
    file.eye_separation = 0.0;
    CHECK(check_displays(file).empty());  // mono
    file.walls[0].stereo = StereoMode::top_bottom;
    check_one(file, "warning: the eye separation is 0 m; expected 0.05 to 0.08 m");
    file.eye_separation = bolt::nan;
    check_one(file, "the eye separation is nan m; expected 0 to 0.1 m");
}

TEST_CASE("Display check: pixels are square, and two eyes have the same number of them") {
    DisplayFile file = with_walls({front_wall()});
    file.walls[0].output.resolution = PixelSize{1920, 1200};
    check_one(file,
              "warning: wall \"front\": its pixels are not square: 3 m by 2.4 m with 1920x1200 pixels, so a "
              "pixel is 0.781 times as wide as high");
    file.walls[0].stereo = StereoMode::side_by_side;
    file.walls[0].output.resolution = PixelSize{3000, 1200};  // two square pictures
    CHECK(check_displays(file).empty());
    file.walls[0].output.resolution = PixelSize{1500, 1200};  // two squeezed ones
    CHECK(check_displays(file).empty());
    file.walls[0].output.resolution = PixelSize{1501, 1200};
    check_one(file, "1501x1200 pixels cannot be halved for two eyes; expected an even width");
    file.walls[0].stereo = StereoMode::top_bottom;
    file.walls[0].output.resolution = PixelSize{1500, 1201};
    check_one(file, "expected an even height");
}

TEST_CASE("Display check: no two outputs have the same pixels") {
    DisplayFile file = with_walls({front_wall(), turned_wall("left", 90.0)});
    CHECK(check_displays(file).empty());
    file.walls[1].output.position = PixelPosition{1499, 0};
    check_one(file, "wall \"front\" and wall \"left\" are shown on the same pixels");
    file.walls[1].output.process = 1;  // another computer
    CHECK(check_displays(file).empty());
    file.walls[1].output.process = 0;
    file.walls[1].output.display = ":0.1";  // another desktop than that of the program
    CHECK(check_displays(file).empty());
    file.walls[0].output.display = ":0";
    file.walls[1].output.display = ":0.0";
    check_one(file, "wall \"front\" and wall \"left\" are shown on the same pixels");
    file.walls[1].output.display = ":0.1";  // another desktop
    CHECK(check_displays(file).empty());
    file = on_monitor("DP-1");
    file.walls[0].stereo = StereoMode::two_outputs;
    file.walls[0].right_output = file.walls[0].output;
    check_one(file,
              "wall \"front\", left output and wall \"front\", right output are shown on the same pixels");
}

TEST_CASE("Display check: outputs are compared with the monitors of this computer") {
    CHECK(check_displays(on_monitor("DP-1"), two_monitors).empty());
    check_one(on_monitor("DP-3"), "wall \"front\": there is no monitor \"DP-3\"; ", two_monitors);
    check_one(on_monitor("PD-2"), "did you mean \"DP-2\"?", two_monitors);
    check_one(on_monitor("HDMI-A-0"), "expected one of DP-1, DP-2", two_monitors);
    DisplayFile file = on_monitor("");
    file.walls[0].output.monitor_index = 2;
    check_one(file, "there is no monitor with the index 2; expected 0 to 1", two_monitors);
    file.walls[0].output.monitor_index = 1;
    check_one(file, "warning: wall \"front\": its pixels are not square: 3 m by 2.4 m with 1920x1080",
              two_monitors);
    file.walls[0].output.monitor_index = 0;
    file.walls[0].output.resolution = PixelSize{1000, 800};
    check_one(file,
              "warning: wall \"front\": the monitor \"DP-1\" has 1500x1200 pixels; expected 1000x800, as the "
              "file says",
              two_monitors);
    CHECK(check_outputs(file, {two_monitors.monitors, 1, ":0"}).empty());  // of another computer
}

TEST_CASE("Display check: the output of this computer is on the X display of the program") {
    DisplayFile file = on_monitor("DP-1");
    file.walls[0].output.display = ":0.0";
    CHECK(check_displays(file, two_monitors).empty());
    file.walls[0].output.display = ":0.1";
    check_one(file,
              "wall \"front\": its output is on the X display \":0.1\"; expected \":0\", that of the program",
              two_monitors);
    CHECK(check_displays(file).empty());  // the display of the program is not known
    file.walls[0].output.process = 1;
    CHECK(check_displays(file, two_monitors).empty());
}

TEST_CASE("Display check: a window must be on monitors, and may extend over several") {
    DisplayFile file = with_walls({front_wall()});
    CHECK(check_displays(file, two_monitors).empty());
    file.walls[0].output.position = PixelPosition{1000, 0};
    check_one(file,
              "the window 1500x1200+1000+0 is not on the monitors; expected it within DP-1 1500x1200+0+0, "
              "DP-2 1920x1080+1500+0",
              two_monitors);
    file.walls[0].output.resolution = PixelSize{1250, 1000};
    CHECK(check_displays(file, two_monitors).empty());  // on both
    file.walls[0].output.position = PixelPosition{-1, 0};
    CHECK(check_displays(file, two_monitors).size() == 1);
    // The index of a monitor and a window on it are the same pixels, which only the monitors show.
    file = with_walls({front_wall(), turned_wall("left", 90.0)});
    file.walls[1].output = {};
    file.walls[1].output.monitor_index = 0;
    CHECK(check_displays(file).empty());
    check_one(file, "are shown on the same pixels", two_monitors);
}

TEST_CASE("Display check: findings that prevent the use come first") {
    DisplayFile file = with_walls({front_wall(), turned_wall("left", 90.0)});
    file.walls[0].output.resolution = PixelSize{1400, 1200};
    file.walls[1].output.position = PixelPosition{100, 0};
    const auto findings = check_displays(file);
    REQUIRE(findings.size() == 2);
    CHECK(findings[0].prevents_use);
    CHECK_FALSE(findings[1].prevents_use);
}

}  // namespace check_displays_test
