#include "content/station/point_table.hpp"

#include <doctest/doctest.h>

#include "tests/support/folder.hpp"

namespace point_table_test {

using namespace bolt;
using namespace bolt::content;

namespace {

std::string error_of(const std::string& text) {
    const auto points = parse_points(text, "p.csv");
    REQUIRE_MESSAGE(!points, text);
    CHECK(points.error().code == ErrorCode::bad_content);
    return points.error().message();
}

}  // namespace

TEST_CASE("Point table: comments, blank lines, blanks and line ends of Windows are read") {
    const auto points =
        parse_points("# corners\r\n\r\n x, y ,z\r\n1,-2.5, 3e-2 \r\n# more\n\n0,0,0", "p.csv");
    REQUIRE_MESSAGE(points, points.error().message());
    REQUIRE(points->size() == 2);
    CHECK((*points)[0] == Vec3(1.0, -2.5, 0.03));
    const auto pairs = parse_point_pairs("ax,ay,az,bx,by,bz\n1,2,3,4,5,6\n", "p.csv");
    REQUIRE(pairs);
    REQUIRE(pairs->size() == 1);
    CHECK((*pairs)[0].from == Vec3(1, 2, 3));
    CHECK((*pairs)[0].to == Vec3(4, 5, 6));
    CHECK(parse_points("x,y,z\n", "p.csv")->empty());
}

TEST_CASE("Point table: errors name file, line and column") {
    CHECK(error_of("") == "p.csv:1:1: the table is empty; expected the title \"x,y,z\"");
    CHECK(error_of("# only\n") == "p.csv:1:1: the table is empty; expected the title \"x,y,z\"");
    CHECK(error_of("1,2,3\n") == "p.csv:1:1: \"1,2,3\" is not the title of the columns; expected \"x,y,z\"");
    CHECK(error_of("x,y,z\n1,two,3\n") ==
          "p.csv:2:3: \"two\" is not a coordinate; expected a number of metres");
    CHECK(error_of("x,y,z\n\n1,2, 3m\n").find("p.csv:3:6: \"3m\" is not a coordinate") == 0);
    CHECK(error_of("x,y,z\n1,2\n") ==
          "p.csv:2:4: the row has 2 of 3 numbers; expected a number for each column");
    CHECK(error_of("x,y,z\n1,2,3,4\n") ==
          "p.csv:2:7: the row has more than 3 numbers; expected a number for each column");
    CHECK(error_of("x,y,z\n1,,3\n").find("p.csv:2:3: \"\" is not a coordinate") == 0);
    for (const char* value : {"nan", "inf", "-inf", "1e7", "1e999"})
        CHECK(error_of("x,y,z\n1,2," + std::string(value)).find("p.csv:2:5: ") == 0);
    std::string many = "x,y,z\n";
    for (int i = 0; i <= 1000; ++i) many += "0,0,0\n";
    CHECK(error_of(many).find("p.csv:1002:1: the table is too long") == 0);
    CHECK(load_points("no/such/file.csv").error().code == ErrorCode::bad_content);
}

}  // namespace point_table_test
