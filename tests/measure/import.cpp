// From the files of a rig to torque over angle, and the mistakes that are reported.
#include "tests/measure/support.hpp"

#include "engine/base/math.hpp"
#include "game/analysis/measured.hpp"
#include "tests/support/replaced.hpp"

namespace import_test {

using namespace measure_test;
using test::replaced;

namespace {

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

void check_message(const std::string& message, std::string_view begin, std::string_view part) {
    CHECK_MESSAGE(message.starts_with(begin), message);
    CHECK_MESSAGE(has(message, part), message);
}

const std::string torque_rig = R"({
  "format": "boltwright rig 1", "title": "Transducer", "direction": "tighten",
  "time": { "rate_Hz": 100 },
  "torque": { "column": "T", "unit": "N.m" },
  "angle": { "speed_deg_s": 25 }
})";

std::string torque_file() {
    std::string out = "T\n";
    for (int i = 0; i <= 560; ++i) out += fmt::format("{}\n", known_torque(0.25 * i));
    return out;
}

}  // namespace

TEST_CASE("Measurement import: force times lever with gain, offset and units") {
    const measure::RigRun run = only_run(import_text(force_rig, force_file(known_torque)));
    CHECK(run.name == "run");
    CHECK(run.rate == doctest::Approx(100.0));
    REQUIRE(run.torque.size() == 561);
    for (std::size_t i = 0; i < run.torque.size(); ++i) {
        CHECK(run.torque[i] == doctest::Approx(known_torque(0.25 * static_cast<double>(i))).epsilon(1e-5));
        CHECK(to_degrees(run.angle[i]) == doctest::Approx(0.25 * static_cast<double>(i)));
    }
}

TEST_CASE("Measurement import: the uncertainty follows the GUM") {
    const measure::RigRun run = only_run(import_text(force_rig, force_file(known_torque)));
    // At 20.5 N·m the force is 82 N; the standard uncertainty of the force 0.2/√12 + 0.4/2 + 0.5 % · 82 N.
    const std::size_t at = 440;
    REQUIRE(run.torque[at] == doctest::Approx(20.5));
    const double u_force = std::sqrt(0.04 / 12.0 + 0.04 + square(0.41));
    CHECK(run.u_torque[at] ==
          doctest::Approx(std::sqrt(square(0.25 * u_force) + square(82.0 * 0.001))).epsilon(1e-4));
    CHECK(to_degrees(run.u_angle) == doctest::Approx(0.1 / std::sqrt(12.0)));
}

TEST_CASE("Measurement import: units agree with their definitions") {
    const auto peak = [](const std::string& unit) {
        const std::string rig = replaced(torque_rig, "\"N.m\"", "\"" + unit + "\"");
        return only_run(import_text(rig, torque_file())).landmarks.peak.torque / known_torque(140.0);
    };
    CHECK(peak("N.mm") == doctest::Approx(1e-3));
    CHECK(peak("lbf.ft") == doctest::Approx(1.3558179483).epsilon(1e-9));
    CHECK(peak("lbf.in") == doctest::Approx(0.1129848290).epsilon(1e-9));
    CHECK(peak("kgf.m") == doctest::Approx(9.80665));
}

TEST_CASE("Measurement import: torque over time with a constant speed, with points, and with a second file") {
    const auto angle_of = [](const measure::RigRun& run, std::size_t i) { return to_degrees(run.angle[i]); };
    const measure::RigRun steady = only_run(import_text(torque_rig, torque_file()));
    CHECK(angle_of(steady, 400) == doctest::Approx(100.0));

    // A stop from 1 s to 2 s.
    const std::string points =
        replaced(torque_rig, "\"speed_deg_s\": 25", "\"points_s_deg\": [[0, 0], [1, 60], [2, 60], [6, 160]]");
    const measure::RigRun stepwise = only_run(import_text(points, torque_file()));
    CHECK(angle_of(stepwise, 50) == doctest::Approx(30.0));
    CHECK(angle_of(stepwise, 150) == doctest::Approx(60.0));
    CHECK(angle_of(stepwise, 400) == doctest::Approx(110.0));

    const std::string joined = replaced(
        torque_rig, "\"speed_deg_s\": 25",
        R"("column": "turns", "unit": "turn", "second_file": {"ending": "_angle.csv", "delay_s": 0.5, "time": {"column": "s"}})");
    const measure::RigRun second =
        only_run(import_text(joined, torque_file(), "s,turns\n0,0\n2,1\n4,2\n6,3\n"));
    CHECK(second.unjoined == 50);  // before 0.5 s
    CHECK(second.time.front() == doctest::Approx(0.5));
    CHECK(angle_of(second, 100) == doctest::Approx(180.0));  // at 1.5 s
    check_message(message_of(import_text(joined, torque_file(), "s,turns\n0,0\n1,1\n1.2,2\n")),
                  "run.csv:2: ", "known from 0.5 s to 1.7 s, but the run lasts from 0 s to 5.6 s");
}

TEST_CASE("Measurement import: tare and reversed channels") {
    std::string file = "t,Fx,phi\n";
    for (int i = 0; i <= 660; ++i) {
        const double angle = std::max(0.0, 0.25 * (i - 100));
        file +=
            fmt::format("{},{:.6f},{}\n", 10 * i, i < 100 ? 3.0 : 3.0 - known_torque(angle) / 0.5, -angle);
    }
    std::string rig = replaced(force_rig, "\"offset\": -1,", "\"tare_s\": 0.98, \"reversed\": true,");
    rig = replaced(rig, "\"unit\": \"deg\",", "\"unit\": \"deg\", \"reversed\": true,");
    const measure::RigRun run = only_run(import_text(rig, file));
    CHECK(run.zero == doctest::Approx(-1.5));
    CHECK(run.torque[0] == doctest::Approx(0.0));
    CHECK(run.torque[660] == doctest::Approx(known_torque(140.0)));
    CHECK(to_degrees(run.angle[660]) == doctest::Approx(140.0));
}

TEST_CASE("Measurement import: loggers' tables with semicolons, decimal commas and a line of units") {
    const std::string rig = replaced(
        torque_rig, "\"time\"",
        R"("table": {"separator": "semicolon", "decimal": "comma", "lines_before_header": 2, "lines_after_header": 1},
                    "cycle": {"column": "run"}, "time")");
    std::string file = "\xEF\xBB\xBFLogger 7\r\nCh;1\r\nrun;T\r\n-;Nm\r\n";
    for (const char* name : {"a", "b"})
        for (int i = 0; i <= 560; ++i) {
            std::string number = fmt::format("{:.4f}", known_torque(0.25 * i));
            std::replace(number.begin(), number.end(), '.', ',');
            file += fmt::format("{};{}\r\n", name, number);
        }
    const auto runs = import_text(rig, file);
    REQUIRE_MESSAGE(runs, message_of(runs));
    REQUIRE(runs->size() == 2);
    CHECK((*runs)[1].name == "b");
    CHECK((*runs)[1].torque[460] == doctest::Approx(known_torque(115.0)));
}

TEST_CASE("Measurement import: mistakes of the file are reported with line and column") {
    const std::string good = force_file(known_torque);
    const auto message = [&](const std::string& from, const std::string& to) {
        return message_of(import_text(force_rig, replaced(good, from, to)));
    };
    check_message(message("40,1.500000,1\n", "40,NaN,1\n"), "run.csv:6:4: ", "'Fx' is NaN");
    check_message(message("40,1.500000,1\n", "40,,1\n"), "run.csv:6:4: ", "'Fx' has no value");
    check_message(message("40,1.500000,1\n", "40,overload,1\n"), "run.csv:6:4: ", "not a number for 'Fx'");
    check_message(message("40,1.500000,1\n", "40,1e300,1\n"), "run.csv:6:4: ", "out of range");
    check_message(message("40,1.500000,1\n", "40,1.5\n"), "run.csv:6:7: ", "has 2 fields");
    check_message(message("\n40,1", "\n30,1"), "run.csv:6:1: ", "the time 0.03 s is not after 0.03 s");
    check_message(message("40,1.500000,1\n", ""), "no error", "");  // one missing row is no gap
    std::string gap = good;
    for (int i = 100; i < 150; ++i)
        gap = replaced(gap, fmt::format("\n{},", 10 * i), fmt::format("\n# {},", 10 * i));
    check_message(message_of(import_text(force_rig, gap)), "run.csv:152:1: ", "a gap of 0.51 s");
    check_message(message_of(import_text(force_rig, "n,t,Fx,phi\nüb,0,x,3\n")),
                  "run.csv:2:6: ", "not a number for 'Fx'");
    check_message(message("t,Fx,phi", "t,Fy,phi"), "run.csv:1:1: ", "there is no column 'Fx'");
    check_message(message_of(import_text(force_rig, "t,Fx,phi\n1,2,3\n")), "run.csv:2: ", "only 1 samples");
    check_message(message_of(import_text(force_rig, "t,Fx,phi\n")), "run.csv:1:1: ", "no rows");
    check_message(message_of(import_text(force_rig, "")), "run.csv:1:1: ", "no line that names the columns");
    check_message(message_of(import_text(force_rig, "t;Fx;phi\n1;2;3\n")), "run.csv:1:1: ", "\"separator\"");
    check_message(message_of(import_text(force_rig, "TDSm\x0e")),
                  "run.csv: ", "is a TDMS file; expected a CSV");
    check_message(message_of(import_text(force_rig, std::string("\xFF\xFEt\0,\0", 6))),
                  "run.csv:1:1: ", "UTF-16");
}

TEST_CASE("Measurement import: wrong units and signs are reported at their place in the rig's description") {
    const std::string good = force_file(known_torque);
    const auto message = [&](const std::string& from, const std::string& to) {
        return message_of(import_text(replaced(force_rig, from, to), good));
    };
    check_message(message("\"gain\": 2", "\"reversed\": true, \"gain\": 2"),
                  "rig.json:9:63: ", "remove \"reversed\"");
    check_message(message("\"direction\": \"tighten\"", "\"direction\": \"loosen\""),
                  "rig.json:8:13: ", "a torque that is negative; set \"reversed\"");
    check_message(message("\"unit\": \"deg\"", "\"unit\": \"deg\", \"reversed\": true"),
                  "rig.json:12:58: ", "remove \"reversed\" of the angle");
    check_message(message("\"deg\", \"resolution\"", "\"rad\", \"gain\": 0.0001, \"resolution\""),
                  "rig.json:12:39: ", "turns by 0.8021 degrees");
    check_message(message("\"gain\": 2", "\"gain\": 200000"),
                  "rig.json:9:29: ", "check unit, gain and lever");
    check_message(message("\"gain\": 2", "\"low_pass_Hz\": 60, \"gain\": 2"),
                  "rig.json:8:13: ", "too high for 100 samples per second; expected at most 45 Hz");
    check_message(message("\"gain\": 2", "\"tare_s\": 0.005, \"gain\": 2"),
                  "rig.json:8:13: ", "only 1 samples");
    check_message(message("\"gain\": 2", "\"tare_s\": 4.5, \"gain\": 2"), "run.csv:2: ", "during the tare");
    const std::string named = replaced(force_rig, "\"Fx\", \"unit\": \"N\"", "\"Fx (kN)\", \"unit\": \"N\"");
    check_message(message_of(import_text(named, replaced(good, "Fx", "Fx (kN)"))),
                  "rig.json:9:34: ", "the unit is N, but the column is named 'Fx (kN)'; expected \"kN\"");
}

TEST_CASE("Measurement import: torque and slope that such a bolt cannot have are reported at their unit") {
    const std::string good = force_file(known_torque);
    const auto message = [&](const std::string& from, const std::string& to) {
        return message_of(import_text(replaced(force_rig, from, to), good));
    };
    check_message(
        message("\"gain\": 2", "\"gain\": 2000"), "rig.json:9:29: ",
        "the largest torque of run is 4.075e+04 N·m; expected 0.094 to 142.9 N·m for a bolt M8; check "
        "unit, gain and lever");
    check_message(message("\"gain\": 2, \"offset\": -1", "\"gain\": 0.002"),
                  "rig.json:9:29: ", "for a bolt M8; check unit, gain and lever");
    // Radians, read as degrees; degrees, read as turns or radians.
    std::string radians = "t,Fx,phi\n", small = "t,Fx,phi\n";
    for (int i = 0; i <= 560; ++i)
        radians += fmt::format("{},{:.6f},{:.6f}\n", 10 * i, (known_torque(0.25 * i) / 0.25 + 1.0) / 2.0,
                               to_radians(0.25 * i));
    check_message(message_of(import_text(force_rig, radians)),
                  "rig.json:12:39: ", "the torque of run rises by 114.");
    check_message(message("\"deg\"", "\"turn\""),
                  "rig.json:12:39: ", "N·m per degree for a bolt M8; check unit");
    const std::string length = replaced(force_rig, "\"thread\"", "\"bolt_length_mm\": 30, \"thread\"");
    CHECK(message_of(import_text(length, good)) == "no error");
    check_message(message_of(import_text(replaced(length, "\"deg\"", "\"rad\""), good)),
                  "rig.json:12:39: ", "for a bolt M8x30; check unit");
    // A short bolt of a weak class is told, too.
    const std::string weak = replaced(force_rig, "\"thread\"", "\"property_class\": \"4.6\", \"thread\"");
    check_message(message_of(import_text(replaced(weak, "\"gain\": 2", "\"gain\": 3"), good)),
                  "rig.json:9:29: ", "for a bolt M8 of class 4.6");
}

TEST_CASE("Measurement import: an encoder that starts again after a turn is unwound, and this is noted") {
    const measure::RigRun straight = only_run(import_text(force_rig, force_file(known_torque)));
    for (const double lowest : {0.0, -180.0}) {
        std::string file = "t,Fx,phi\n";
        for (int i = 0; i <= 560; ++i) {
            const double angle = 0.25 * i + 250.0 + lowest;  // starts again at the steepest part
            file += fmt::format("{},{:.6f},{}\n", 10 * i, (known_torque(0.25 * i) / 0.25 + 1.0) / 2.0,
                                lowest + std::fmod(angle - lowest, 360.0));
        }
        const measure::RigRun run = only_run(import_text(force_rig, file));
        REQUIRE(run.notes.size() == 1);
        CHECK(has(run.notes[0], "starts again"));
        CHECK(run.landmarks.peak.torque == doctest::Approx(straight.landmarks.peak.torque));
        REQUIRE(run.landmarks.yield);
        CHECK(run.landmarks.yield->torque == doctest::Approx(straight.landmarks.yield->torque));
    }
    CHECK(straight.notes.empty());
}

TEST_CASE("Measurement import: missing samples show in the angle, with a sampling rate too") {
    std::string rig = replaced(force_rig, "\"column\": \"t\", \"unit\": \"ms\"", "\"rate_Hz\": 100");
    std::string file = force_file(known_torque);
    for (int i = 400; i < 480; ++i)
        file = replaced(file, fmt::format("\n{},", 10 * i), fmt::format("\n# {},", 10 * i));
    check_message(
        message_of(import_text(rig, file)), "run.csv:482:",
        "the angle jumps by 20.25 degrees from the sample before; the usual step is at most 0.25 degrees; "
        "expected samples without gaps");
    rig = replaced(rig, "\"unit\": \"deg\",", "\"unit\": \"deg\", \"largest_step_deg\": 25,");
    CHECK(message_of(import_text(rig, file)) == "no error");
}

TEST_CASE("Measurement import: an uneven clock is refused for the low pass only") {
    std::string file = "t,Fx,phi\n";
    double t = 0.0;
    for (int i = 0; i <= 560; ++i) {
        file += fmt::format("{},{:.6f},{}\n", t, (known_torque(0.25 * i) / 0.25 + 1.0) / 2.0, 0.25 * i);
        t += i < 280 ? 10.0 : 30.0;
    }
    CHECK(import_text(force_rig, file).has_value());
    const std::string filtered = replaced(force_rig, "\"gain\"", "\"low_pass_Hz\": 5, \"gain\"");
    check_message(message_of(import_text(filtered, file)), "run.csv:", "not evenly spaced");
}

TEST_CASE("Measurement import: a saturated amplifier is noted") {
    const auto clipped = [](double angle) { return std::min(known_torque(angle), 20.0); };
    const measure::RigRun run = only_run(import_text(force_rig, force_file(clipped)));
    REQUIRE(run.notes.size() == 1);
    CHECK(has(run.notes[0], "amplifier"));
    CHECK(only_run(import_text(force_rig, force_file(known_torque))).notes.empty());
}

TEST_CASE("Measurement import: compare reads the record back") {
    auto runs = import_text(force_rig, force_file(known_torque));
    REQUIRE(runs);
    runs->push_back(runs->front());
    measure::name_uniquely(*runs);
    runs->front().name = "a \"b\", c";
    const std::string csv = measure::record_csv(parsed_rig(force_rig), *runs);
    const auto record = analysis::parse_measured(csv, "record.csv");
    if (!record) FAIL(record.error().message());
    CHECK(record->source == "these tests");
    REQUIRE(record->cycles.size() == 2);
    CHECK(record->cycles[0].name == "a \"b\", c");
    CHECK(record->cycles[1].name == "run (2)");
    CHECK(record->direction == joint::Direction::tighten);
    const analysis::TorqueCurve curve =
        analysis::make_torque_curve(record->cycles[0].angle, record->cycles[0].torque, record->direction);
    CHECK(measure::find_landmarks(curve).linear->slope ==
          doctest::Approx((*runs)[1].landmarks.linear->slope).epsilon(1e-4));
}

}  // namespace import_test
