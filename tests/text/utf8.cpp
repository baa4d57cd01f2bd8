#include "engine/text/layout.hpp"

#include <doctest/doctest.h>

using namespace bolt::text;

TEST_CASE("UTF-8: decoding and encoding are inverse") {
    const std::string text = "M8 × 30, Anziehdrehmoment ≈ 25 N·m, Größe, 预紧力 \xF0\x9F\x94\xA7";
    const std::u32string points = decode(text);
    CHECK(points.size() == 48);
    CHECK(points[3] == U'×');
    CHECK(points.back() == U'\U0001F527');
    CHECK(encode(points) == text);
    CHECK(encode(std::u32string{0x7F, 0x80, 0x7FF, 0x800, 0xFFFF, 0x10000, 0x10FFFF}) ==
          "\x7F\xC2\x80\xDF\xBF\xE0\xA0\x80\xEF\xBF\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF");
}

TEST_CASE("UTF-8: each invalid byte is replaced by U+FFFD, and decoding continues") {
    const std::u32string mark(1, 0xFFFD);
    CHECK(decode("a\xFFz") == U"a" + mark + U"z");
    CHECK(decode("\xC3") == mark);                                   // truncated
    CHECK(decode("\xE2\x82") == mark + mark);                        // truncated
    CHECK(decode("\xC3(") == mark + U"(");                           // no continuation byte
    CHECK(decode("\xC0\xAF") == mark + mark);                        // overlong
    CHECK(decode("\xE0\x80\xAF") == mark + mark + mark);             // overlong
    CHECK(decode("\xED\xA0\x80") == mark + mark + mark);             // surrogate
    CHECK(decode("\xF4\x90\x80\x80") == mark + mark + mark + mark);  // beyond Unicode
    CHECK(decode("").empty());
}
