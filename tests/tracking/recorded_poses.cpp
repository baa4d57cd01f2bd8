// Recorded poses of a tracker, from CSV files.
#include "engine/tracking/recorded_poses.hpp"

#include <doctest/doctest.h>

#include "engine/base/file.hpp"
#include "tests/support/folder.hpp"

namespace recorded_poses_test {

using namespace bolt;
using namespace bolt::tracking;

namespace {

const std::string title = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";

void check_error(const std::string& text, const std::string& message) {
    const auto poses = parse_recorded_poses(text, "w.csv");
    REQUIRE_MESSAGE(!poses, text);
    CHECK(poses.error().code == ErrorCode::bad_content);
    CHECK_MESSAGE(poses.error().message().find(message) == 0, poses.error().message());
}

}  // namespace

TEST_CASE("Recorded poses: rows, comments, blanks and other line ends are read") {
    const auto poses = parse_recorded_poses(
        "# walk\r\n\n" + title + "0, 1, 2 ,3,1,0,0,0\r\n# lost\n 0.5,-1,2e-1,+3,0,1,0,0\n", "w.csv");
    REQUIRE_FALSE(poses);  // from_chars takes no plus sign
    const auto good = parse_recorded_poses(
        "# walk\r\n\n" + title + "0, 1, 2 ,3,1,0,0,0\r\n# lost\n 0.5,-1,2e-1,3,0,1,0,0", "w.csv");
    if (!good) FAIL(good.error().message());
    REQUIRE(good->size() == 2);
    CHECK((*good)[0].pose.position == Vec3(1, 2, 3));
    CHECK((*good)[1].time == 0.5);
    CHECK((*good)[1].pose.position == Vec3(-1, 0.2, 3));
    CHECK((*good)[1].pose.orientation == Quat(0, 1, 0, 0));
}

TEST_CASE("Recorded poses: errors name the line and the column of the mistake") {
    check_error("", "w.csv:1:1: the recording has no poses; expected t_s,x_m");
    check_error(title, "w.csv:1:1: the recording has no poses");
    check_error("x,y\n", "w.csv:1:1: the column titles are wrong; expected t_s,x_m,y_m,z_m,qw,qx,qy,qz");
    check_error(title + "0,1,2,x,1,0,0,0\n", "w.csv:2:7: column 4 is not a number");
    check_error(title + "0,1,2,nan,1,0,0,0\n", "w.csv:2:7: column 4 is not a number");
    check_error(title + "0,1,2,1e9,1,0,0,0\n", "w.csv:2:7: column 4 is not a number");
    check_error(title + "0,1,2\n", "w.csv:2:6: column 3 does not end here; expected a comma");
    check_error(title + "0,1,2,3,1,0,0,0,9\n",
                "w.csv:2:16: column 8 does not end here; expected the end of the line");
    check_error(title + "0;1;2;3;1;0;0;0\n", "w.csv:2:2: column 1 does not end here");
    check_error(title + "0,1,2,3,1,1,0,0\n",
                "w.csv:2:1: the quaternion has the length 1.41421; expected a unit");
    check_error(title + "0,1,2,3,1,0,0,0\n0,1,2,3,1,0,0,0\n",
                "w.csv:3:1: the time 0 s is not after that of the line before; expected times that increase");
    const auto missing = load_recorded_poses("/nonexistent/w.csv");
    REQUIRE_FALSE(missing);
    CHECK(missing.error().message().find("/nonexistent/w.csv") != std::string::npos);
}

TEST_CASE(
    "Recorded poses: poses_between returns the poses after the first time up to the second, and none in a "
    "gap") {
    const test::Folder folder;
    std::string text = title;
    for (const char* time : {"0", "0.1", "0.2", "1.0", "1.1"}) text += std::string(time) + ",0,0,0,1,0,0,0\n";
    REQUIRE(write_file(folder / "w.csv", text));
    const auto loaded = load_recorded_poses(folder / "w.csv");
    REQUIRE(loaded);
    const std::span<const BodySample> poses = *loaded;
    CHECK(poses_between(poses, -1.0, 0.0).size() == 1);
    CHECK(poses_between(poses, 0.0, 0.15).size() == 1);
    CHECK(poses_between(poses, 0.0, 0.15).front().time == 0.1);
    CHECK(poses_between(poses, 0.2, 0.9).empty());
    CHECK(poses_between(poses, 0.2, 2.0).size() == 2);
    CHECK(poses_between(poses, 5.0, 2.0).empty());
}

}  // namespace recorded_poses_test
