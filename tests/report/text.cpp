#include "game/plot/html.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace bolt::plot;

TEST_CASE("Report text: markup is escaped in text and attributes") {
    CHECK(escape("<script>alert('x')</script>") == "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;");
    CHECK(escape("a \"b\" & c") == "a &quot;b&quot; &amp; c");
    CHECK(escape("Zwölf Schrauben – 十二") == "Zwölf Schrauben – 十二");
}

TEST_CASE("Report text: invalid UTF-8 is replaced") {
    const std::string bad = "\xEF\xBF\xBD";
    CHECK(escape(std::string_view("a\0b", 3)) == "a" + bad + "b");
    CHECK(escape("\x1B[0m") == bad + "[0m");
    CHECK(escape("\xFF") == bad);
    CHECK(escape("\xC0\xAF") == bad + bad);            // overlong '/'
    CHECK(escape("\xED\xA0\x80") == bad + bad + bad);  // half of a surrogate pair
    CHECK(escape("\xE2\x82") == bad + bad);            // cut off
}

TEST_CASE("Report text: numbers have a minus sign and no negative zero") {
    CHECK(number(-12.345, 1) == "−12.3");
    CHECK(number(-0.04, 1) == "0.0");
    CHECK(number(206.0, 1) == "206.0");
    CHECK(number(std::numeric_limits<double>::quiet_NaN(), 1) == "–");
    CHECK(number(std::numeric_limits<double>::infinity(), 1) == "–");
    CHECK(signed_number(2.0, 1) == "+2.0");
    CHECK(signed_number(0.01, 1) == "0.0");
    CHECK(signed_number(-5.0, 1) == "−5.0");
}

TEST_CASE("Report text: durations in seconds, minutes and hours") {
    CHECK(duration_text(12.34) == "12.3 s");
    CHECK(duration_text(59.96) == "1 min 00 s");
    CHECK(duration_text(204.4) == "3 min 24 s");
    CHECK(duration_text(3661.0) == "1 h 01 min 01 s");
}
