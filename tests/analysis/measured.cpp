#include "game/analysis/measured.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::analysis;

namespace {

const std::string head = "angle_deg,torque_Nm\n";
const std::string rows = "0,0.1\n1,0.2\n2,0.4\n3,0.8\n4,1.6\n";

std::string error_of(const std::string& text) {
    const Result<MeasuredRecord> read = parse_measured(text, "m.csv");
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().code == ErrorCode::bad_content);
    return read.error().message();
}

std::filesystem::path data_folder() {
    return std::filesystem::path(__FILE__).parent_path().parent_path() / "data";
}

}  // namespace

TEST_CASE("Measured file: plain columns") {
    const Result<MeasuredRecord> read = parse_measured(head + rows, "m.csv");
    REQUIRE(read);
    REQUIRE(read->cycles.size() == 1);
    CHECK(read->direction == joint::Direction::tighten);
    CHECK(read->samples() == 5);
    CHECK(to_degrees(read->cycles[0].angle[3]) == doctest::Approx(3.0));
    CHECK(read->cycles[0].torque[4] == 1.6);
    CHECK(read->source.empty());
}

TEST_CASE("Measured file: byte order mark, CRLF, comments, blank lines, quotes and other columns") {
    const std::string text =
        "\xEF\xBB\xBF# source: A. Rig, Lab Book 7, CC0 \r\n\r\n\"note, \"\"x\"\"\" , "
        "torque_Nm,speed_rpm,\"angle_deg\"\r\n"
        "a,+0.1,5,0\r\n   \r\n# between\r\n\"b, c\", \"0.2\" ,5,1\r\nd,3e-1,5,2\r\n,0.4,,3\r\ne,0.5,x,4";
    const Result<MeasuredRecord> read = parse_measured(text, "m.csv");
    REQUIRE_MESSAGE(read, (read ? "" : read.error().message()));
    CHECK(read->samples() == 5);
    CHECK(read->cycles[0].torque[2] == 0.3);
    CHECK(read->source == "A. Rig, Lab Book 7, CC0");
}

TEST_CASE("Measured file: cycles with mixed rows") {
    std::string text = "cycle,angle_deg,torque_Nm\n";
    for (int i = 0; i < 6; ++i)
        for (const char* cycle : {"7", "9"})
            text += std::string(cycle) + "," + std::to_string(i) + ",-" + std::to_string(i) + ".5\n";
    const Result<MeasuredRecord> read = parse_measured(text, "m.csv");
    REQUIRE(read);
    REQUIRE(read->cycles.size() == 2);
    CHECK(read->cycles[1].name == "9");
    CHECK(read->cycles[1].line == 3);
    CHECK(read->cycles[1].angle.size() == 6);
    CHECK(read->direction == joint::Direction::loosen);
}

TEST_CASE("Measured file: errors give line, column and expectation") {
    CHECK(error_of("") == "m.csv:1:1: there is no header line; expected columns 'angle_deg' and 'torque_Nm'");
    CHECK(error_of("# only a comment\n") ==
          "m.csv:1:1: there is no header line; expected columns 'angle_deg' and 'torque_Nm'");
    CHECK(error_of(head) == "m.csv:1:1: there are no samples; expected at least 5 rows");
    CHECK(error_of("angel_deg,torque_Nm\n" + rows) ==
          "m.csv:1:1: there is no column 'angle_deg'; expected 'angle_deg' instead of 'angel_deg'");
    CHECK(error_of("angle_deg, torque_nm\n" + rows) ==
          "m.csv:1:12: there is no column 'torque_Nm'; expected 'torque_Nm' instead of 'torque_nm'");
    CHECK(error_of("a,b\n" + rows) ==
          "m.csv:1:1: there is no column 'angle_deg'; expected a first line that names the columns "
          "'angle_deg' and 'torque_Nm'");
    CHECK(error_of("angle_deg;torque_Nm\n0;1\n") ==
          "m.csv:1:1: there is no column 'angle_deg'; expected columns separated by commas, with a decimal "
          "point");
    CHECK(error_of("angle_deg,torque_Nm,angle_deg\n") ==
          "m.csv:1:21: column 'angle_deg' appears twice; expected each column once");
    CHECK(error_of(head + "0,0.1\n1\n") == "m.csv:3:2: this row has 1 fields; expected 2, as in the header");
    CHECK(error_of(head + "0,0.1,7\n") == "m.csv:2:7: this row has 3 fields; expected 2, as in the header");
    CHECK(error_of(head + "0,zero\n") ==
          "m.csv:2:3: 'zero' is not a number for 'torque_Nm'; expected a decimal number such as -12.5");
    CHECK(error_of(head + "0, 1.5 N\n") ==
          "m.csv:2:4: '1.5 N' is not a number for 'torque_Nm'; expected a decimal number such as -12.5");
    CHECK(error_of(head + "nan,1\n") ==
          "m.csv:2:1: 'nan' is not a number for 'angle_deg'; expected a decimal number such as -12.5");
    CHECK(error_of(head + "0,inf\n") ==
          "m.csv:2:3: 'inf' is not a number for 'torque_Nm'; expected a decimal number such as -12.5");
    CHECK(error_of(head + "0,\n") ==
          "m.csv:2:3: '' is not a number for 'torque_Nm'; expected a decimal number such as -12.5");
    CHECK(error_of(head + "0,1e9\n") ==
          "m.csv:2:3: 1e9 is out of range for 'torque_Nm'; expected a value between -1000000 and 1000000");
    CHECK(error_of(head + "0,\"1\n") ==
          "m.csv:2:3: this quote is not closed on its line; expected a closing '\"'");
    CHECK(error_of(head + "\"0\"x,1\n") ==
          "m.csv:2:4: there is text after a quoted field; expected a comma or the end of the line");
    const std::string umlaut = "cycle," + head + "Prüfung,";  // columns count characters, not bytes
    CHECK(error_of(umlaut + "0,zero\n") ==
          "m.csv:2:11: 'zero' is not a number for 'torque_Nm'; expected a decimal number such as -12.5");
    CHECK(error_of(umlaut + "0,\"1\n") ==
          "m.csv:2:11: this quote is not closed on its line; expected a closing '\"'");
    CHECK(error_of(umlaut + "0\n") == "m.csv:2:10: this row has 2 fields; expected 3, as in the header");
    CHECK(error_of(head + "0,1\n1,2\n2,3\n3,4\n") ==
          "m.csv:2:1: this file has only 4 samples; expected at least 5");
    CHECK(error_of("cycle," + head + "a,0,1\na,1,1\na,2,1\na,3,1\na,4,1\nb,0,1\n") ==
          "m.csv:7:1: cycle 'b' has only 1 samples; expected at least 5");
    CHECK(error_of(head + "0,0\n1,0\n2,0\n3,0\n4,0\n") ==
          "m.csv:2:1: this file has only zero torques; expected a run with a load");
    CHECK(error_of("cycle," + head +
                   "a,0,1\na,1,1\na,2,1\na,3,1\na,4,1\nb,0,-1\nb,1,-1\nb,2,-1\nb,3,-1\nb,4,-1\n") ==
          "m.csv:7:1: cycle 'b' turns in the other direction than the cycles before; expected all cycles "
          "of a file tightening (torque positive) or all loosening (negative)");
}

TEST_CASE("Measured file: the error for a missing file names it") {
    const Result<MeasuredRecord> read = read_measured("no/such/file.csv");
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().message().starts_with("no/such/file.csv: cannot be opened"));
}

TEST_CASE("Measured file: the runs of one joint can be selected") {
    std::string text = "# bolt_length_mm: 75\n# property_class: 8.8\ncycle,angle_deg,torque_Nm\n";
    for (const char* cycle : {"B1", "B2", "F1"})
        for (int i = 0; i < 6; ++i)
            text += std::string(cycle) + "," + std::to_string(i) + "," + std::to_string(i) + ".5\n";
    Result<MeasuredRecord> read = parse_measured(text, "m.csv");
    REQUIRE(read);
    CHECK(read->bolt_length == "75");
    CHECK(read->property_class == "8.8");
    REQUIRE(select_runs(*read, {}));
    CHECK(read->cycles.size() == 3);
    const Status unknown = select_runs(*read, {"B1", "F2"});
    REQUIRE_FALSE(unknown);
    CHECK(unknown.error().message() == "m.csv: there is no run \"F2\"; expected one of B1, B2, F1");
    REQUIRE(select_runs(*read, {"F1", "B2"}));
    REQUIRE(read->cycles.size() == 2);
    CHECK(read->cycles[0].name == "B2");
}

TEST_CASE("Measured file: the published loosening runs are read with their source") {
    const Result<MeasuredRecord> read = read_measured(data_folder() / "m8_releasable.csv");
    REQUIRE_MESSAGE(read, (read ? "" : read.error().message()));
    CHECK(read->direction == joint::Direction::loosen);
    CHECK(read->cycles.size() == 5);
    CHECK(read->samples() == 800);
    CHECK(read->source.starts_with(
        "Al Assadi et al., J. Manuf. Syst. 65 (2022) 19-32, dataset_unfastening, CC BY 4.0"));
    // The published files do not contain their source.
    const Result<MeasuredRecord> bare = parse_measured(head + rows, "some/where/m6_releasable.csv");
    REQUIRE(bare);
    CHECK(bare->source ==
          "Al Assadi et al., J. Manuf. Syst. 65 (2022) 19–32, dataset_unfastening, CC BY 4.0");
}

TEST_CASE("Measured file: a thousand broken files give a value or an error with a position") {
    const std::string good = "# source: rig\ncycle,angle_deg,torque_Nm\n" + [] {
        std::string text;
        for (int i = 0; i < 12; ++i)
            text += "\"1\"," + std::to_string(i) + "," + std::to_string(0.5 * i) + "\n";
        return text;
    }();
    REQUIRE(parse_measured(good, "m.csv"));
    constexpr char bytes[] = {',', '"', '\n', '\r', '#', '-', '.', 'e', '9', ' ', '\0', '\xFF', 'n'};
    Random random(2022);
    int failed = 0;
    for (int round = 0; round < 1000; ++round) {
        std::string text = good;
        for (std::uint32_t k = 1 + random.bits() % 4U; k > 0; --k) {
            const std::size_t at = random.bits() % text.size();
            const char byte = bytes[random.bits() % sizeof bytes];
            switch (random.bits() % 4U) {
                case 0:
                    text[at] = byte;
                    break;
                case 1:
                    text.insert(at, 1, byte);
                    break;
                case 2:
                    text.erase(at, 1 + random.bits() % 5U);
                    break;
                default:
                    text.resize(at);
                    break;
            }
            if (text.empty()) break;
        }
        const Result<MeasuredRecord> read = parse_measured(text, "m.csv");
        if (read) {
            CHECK(read->samples() >= min_samples);
            continue;
        }
        ++failed;
        CHECK(read.error().line >= 1);
        CHECK(read.error().column >= 1);
        CHECK_FALSE(read.error().expected.empty());
    }
    CHECK(failed > 300);
    CHECK(failed < 1000);
}
