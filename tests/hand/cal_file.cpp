#include "haptics/hand/glove_calibration.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/support/replaced.hpp"

using namespace bolt;
using namespace bolt::hand;
using test::replaced;

namespace {

// Word 1 is "Thumb_0", so the sixth is the offset and the ninth the gain.
std::string sample() {
    std::string text = "CyberGlove calibration\n";
    int n = 0;
    for (const char* block : {"Thumb", "Index", "Middle", "Ring", "Pinky", "Palm"}) {
        text += fmt::format("{}:\n", block);
        for (int i = 0; i < 4; ++i, ++n)
            text += fmt::format("  {}_{} a b c d {}.5 e f {} g\n", block, i, 50 + n, -0.01 - 0.0001 * n);
    }
    return text;
}

}  // namespace

TEST_CASE(
    "CalFile: offsets and gains reach their sensors; the middle finger's abduction takes its gain from the "
    "index line") {
    const Result<Calibration> c = parse_cal(sample(), "right.cal");
    REQUIRE_MESSAGE(c, (c ? "" : c.error().message()));
    const auto fit = [&](Sensor s) { return *c->fits[index(s)]; };
    CHECK(fit(Sensor::thumb_roll).offset == 50.5);
    CHECK(fit(Sensor::thumb_roll).gain == doctest::Approx(-0.01));
    CHECK(fit(Sensor::index_mpj).offset == 54.5);
    CHECK(fit(Sensor::middle_abduction).offset == 61.5);
    CHECK(fit(Sensor::middle_abduction).gain == doctest::Approx(-0.01 - 0.0007));
    CHECK(fit(Sensor::palm_arch).offset == 70.5);
    CHECK(fit(Sensor::wrist_yaw).offset == 72.5);
    CHECK(angle(fit(Sensor::thumb_roll), 30.5) == doctest::Approx(0.2));
    for (const Sensor s : sensors_of(22)) CHECK(c->fits[index(s)]);
}

TEST_CASE("CalFile: CRLF, tabs and a missing final newline change nothing") {
    std::string text;
    for (const char c : sample()) {
        if (c == '\n') text += '\r';
        text += c == ' ' ? '\t' : c;
    }
    text.pop_back();
    CHECK(parse_cal(text, "x"));
}

TEST_CASE("CalFile: errors name line and column") {
    const auto message = [](const std::string& text) {
        const Result<Calibration> c = parse_cal(text, "hand.cal");
        REQUIRE(!c);
        CHECK(c.error().code == ErrorCode::bad_content);
        return c.error().message();
    };
    CHECK(message("").find("hand.cal:1") == 0);
    CHECK(message(replaced(sample(), "52.5", "5z.5")).find("hand.cal:5:19: \"5z.5\" is not a number") == 0);
    CHECK(message(replaced(sample(), "52.5", "inf")).find("is not a number") != std::string::npos);
    CHECK(message(replaced(sample(), "-0.0102", "-9")).find("a gain of -9") != std::string::npos);
    CHECK(message(replaced(sample(), " e f -0.0102 g", "")).find("hand.cal:5") == 0);
    const std::string whole = sample();
    for (std::size_t cut = 0; cut + 40 < whole.size(); cut += 7)
        CHECK(!parse_cal(std::string_view(whole).substr(0, cut), "x"));
}
