#include <doctest/doctest.h>

#include <algorithm>

#include "support.hpp"

namespace content_syntax_test {

using namespace content_test;

namespace {

// One edit of a correct file, and the complete list of messages that it causes.
struct SyntaxEdit {
    const char* from;
    const char* to;
    std::vector<std::string> messages;
};

// clang-format off
const SyntaxEdit edits[] = {
    {R"(,
  "views")", R"(
  "views")",
     {R"(58:3: something is missing before this text; expected ',' or '}')"}},
    {R"("top")", R"(top)",
     {R"(60:15: unknown word "top"; expected a number, a text in double quotes, true or false)"}},
    {R"(true)", R"(True)",
     {R"(30:28: unknown word "True"; did you mean true?)"}},
    {R"(13.2)", R"(13,2)",
     {R"(16:15: "13,2" with a comma; expected a decimal point)"}},
    {R"(13.2)", R"(1e999)",
     {R"(16:15: the number 1e999 is too large; expected less than 1e308)"}},
    {R"(13.2)", R"(NaN)",
     {R"(16:15: unknown word "NaN"; expected a number, a text in double quotes, true or false)"}},
    {R"(13.2)", R"(013.2)",
     {R"(16:15: "013.2" is not a number as JSON writes it; expected as in 1.5, -2 or 3e-6: digits on both sides of the point, no leading zero or plus, no unit)"}},
    {R"(13.2)", R"(13 .2)",
     {R"(16:18: something is missing before ".2"; expected ',' or '}')"}},
    {R"(140
  },)", R"(140,
  },)",
     {R"(18:28: nothing follows this comma but '}'; expected no comma here, or another value)"}},
    {R"(140
  },)", R"(140 // long
  },)",
     {R"(18:29: JSON has no comments; expected no comment; in assembly.json "sources" can hold notes)"}},
    {R"("tool")", R"('tool')",
     {R"(14:3: single quotes; expected double quotes ("))"}},
    {R"("tool")", R"(tool)",
     {R"(14:3: "tool" without quotes; expected a name in double quotes)"}},
    {R"("tool":)", R"("tool")",
     {R"(14:10: '{' is not allowed here; expected ':' and a value)"}},
    {R"("tool":)", R"("tool" =)",
     {R"(14:10: '=' is not allowed here; expected ':' and a value)"}},
    {R"(Fasten the)", "Fasten\nthe",
     {R"(9:18: the text that begins at 9:11 is not closed on its line; expected a '"' at its end)"}},
    {R"(Fasten the)", "Fasten\tthe",
     {R"(9:18: control character 0x09 in a text; expected \u0009)"}},
    {R"(Fasten the)", R"(Fasten \the \d)",
     {R"(9:24: an invalid escape sequence; expected \\ for a backslash, or one of \" \/ \b \f \n \r \t \uXXXX)"}},
    {R"(Fasten the)", R"(Fasten \ud800 the)",
     {R"(9:19: half of a surrogate pair; expected both halves, or the character itself)"}},
    {R"(Fasten the)", "Fasten \xFF the",
     {R"(9:19: byte 0xFF is not UTF-8; expected UTF-8)"}},
    {R"([0, 500, 1])", R"([0, 500, 1)",
     {R"(60:55: ':' is not allowed here, and the '[' opened at 60:32 is not closed; expected ',' or ']')"}},
    {R"([0, 500, 1])", R"([0, 500 1])",
     {R"(60:40: something is missing before "1"; expected ',' or ']')"}},
    {R"([0, 500, 1])", R"([0, 500, 1})",
     {R"(60:42: '}' is not allowed here, and the '[' opened at 60:32 is not closed; expected ',' or ']')"}},
    {R"({ "kind": "recheck" })", R"({ "kind": "recheck")",
     {R"(57:3: ']' is not allowed here, and the '{' opened at 56:5 is not closed; expected ',' or '}')"}},
    {R"([50, 10, -40] },)", R"([50, 10, -40],)",
     {R"(48:5: '{' is not allowed here, and the '{' opened at 47:5 is not closed; expected a name in double quotes)"}},
    {R"("risk_class": "C"
      })", R"("risk_class": "C")",
     {R"(61:2: the file ends too early, and the '{' opened at 1:1 is not closed; expected ',' or '}'; by the indentation it is the '{' opened at 36:15 that lacks its '}')"}},
    {R"("id": "B2", "type")", R"("id": "B2, "type")",
     {R"(47:19: something is missing before "type"; expected ',' or '}', or a '"' that closes the text that begins at 47:13)"}},
    {R"("zh": "四个 M8 螺栓的盖板")", R"("zh": "四个 M8 螺栓的盖板)",
     {R"(6:23: the text that begins at 6:11 is not closed on its line; expected a '"' at its end)"}},
    {R"([0, 500, 1])", R"([0, 500, ])",
     {R"(60:39: nothing follows this comma but ']'; expected no comma here, or another value)"}},
};
// clang-format on

}  // namespace

TEST_CASE("JSON syntax: a syntax error is reported in plain words at its position") {
    const std::string good = cover();
    for (const SyntaxEdit& c : edits) {
        CAPTURE(c.from);
        CAPTURE(c.to);
        const std::vector<std::string> given = messages(edited(good, c.from, c.to));
        REQUIRE(given.size() == c.messages.size());
        for (std::size_t i = 0; i < given.size(); ++i) CHECK(given[i] == c.messages[i]);
    }
}

namespace {

std::string only_message(std::string_view text) {
    const std::vector<std::string> all = messages(text);
    return all.size() == 1 ? all[0] : "messages: " + std::to_string(all.size());
}

}  // namespace

TEST_CASE("JSON syntax: a text that is not JSON gives one error with a line") {
    CHECK(only_message("") == "1:1: the file is empty; expected '{'");
    CHECK(only_message(" \n\t\n") == "1:1: the file is empty; expected '{'");
    CHECK(only_message("hello") ==
          "1:1: unknown word \"hello\"; expected a number, a text in double quotes, true or false");
    CHECK(only_message("{") ==
          "1:2: the file ends too early, and the '{' opened at 1:1 is not closed; expected a name in double "
          "quotes or '}'");
    CHECK(only_message("{\"a\": [1,\n") ==
          "1:10: the file ends too early, and the '[' opened at 1:7 is not closed; expected a value");
    CHECK(only_message("{} {}") == "1:4: '{' is not allowed here; expected the end of the file");
    CHECK(only_message("<xml/>") == "1:1: '<' is not allowed here; expected '{'");
    CHECK(only_message("[1.5.2]") ==
          "1:2: \"1.5.2\" is not a number as JSON writes it; expected as in 1.5, -2 or 3e-6: "
          "digits on both sides of the point, no leading zero or plus, no unit");
    CHECK(only_message("[5mm]") ==
          "1:2: \"5mm\" is not a number as JSON writes it; expected as in 1.5, -2 or 3e-6: "
          "digits on both sides of the point, no leading zero or plus, no unit");
    CHECK(only_message("\"abc") ==
          "1:5: the text that begins at 1:1 is not closed; expected a '\"' at its end");
    CHECK(only_message(std::string_view("{}\0", 3)) == "1:3: byte 0x00; expected text");
    CHECK(only_message(std::string_view("\xFF\xFE{\0}\0", 6)) == "1:1: the file is UTF-16; expected UTF-8");
    CHECK(only_message("{\"\xE4\": 1}") == "1:3: byte 0xE4 is not UTF-8; expected UTF-8");
    CHECK(only_message("{\"\": 1}") == "1:2: an empty name; expected a name of at least one letter");
    CHECK(only_message("{\"a\\u0001\": 1}") ==
          "1:2: a name with a control character in it; expected plain text");
    CHECK(only_message("{\"" + std::string(200, 'k') + "\": 1}") ==
          "1:2: a name of more than 128 bytes; expected a shorter name");
}

TEST_CASE("JSON syntax: JSON that is not an object is refused") {
    CHECK(only_message("[]") == "1:1: a list [...] is not allowed here; expected an object {...}");
    CHECK(only_message("null") == "1:1: null is not allowed here; expected an object {...}");
    CHECK(only_message("  3") == "1:3: the number 3 is not allowed here; expected an object {...}");
}

TEST_CASE("JSON syntax: a byte order mark is allowed and does not shift the columns") {
    CHECK(messages("\xEF\xBB\xBF" + cover()).empty());
    CHECK(only_message("\xEF\xBB\xBF[]") ==
          "1:1: a list [...] is not allowed here; expected an object {...}");
    CHECK(only_message("\xEF\xBB\xBF") == "1:1: the file is empty; expected '{'");
}

TEST_CASE("JSON syntax: columns count characters, and a tab is one") {
    CHECK(only_message("{\"zh\":\t\"四个 µ\", 1}") ==
          "1:16: \"1\" without quotes; expected a name in double quotes");
    CHECK(only_message("\xEF\xBB\xBF{\"\xF0\x9F\x94\xA9\": 1,\n\"é\", 1}") ==
          "2:4: ',' is not allowed here; expected ':' and a value");
    CHECK(only_message("[\"äö\", \"\xFF\"]") == "1:9: byte 0xFF is not UTF-8; expected UTF-8");
}

TEST_CASE(
    "JSON syntax: an unclosed bracket is the innermost open one, unless the indentation shows another") {
    CHECK(only_message("{\"a\": {\n\"b\": [1],\n\"c\": 2\n}")
              .starts_with("4:2: the file ends too early, and the '{' opened at 1:1 is not closed; expected "
                           "',' or '}'"));
    CHECK(only_message("{\n  \"a\": [\n    {\n      \"b\": 1\n  ],\n  \"c\": 2\n}\n") ==
          "5:3: ']' is not allowed here, and the '{' opened at 3:5 is not closed; expected ',' or '}'");
    CHECK(only_message("{\"a\": \"x\\\\\\\"\"b}") ==
          "1:14: something is missing before \"b\"; expected ',' or '}', or a '\"' that closes the text "
          "that begins at 1:7");
}

TEST_CASE("JSON syntax: Windows line ends count as lines") {
    std::string text = edited(cover(), "\"M8x30\"", "\"M8x30 \"");
    for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.insert(i, "\r");
    const auto loaded = bolt::content::parse_assembly(text, "f");
    REQUIRE_FALSE(loaded.ok());
    CHECK(loaded.errors.back().line == 49);
}

TEST_CASE("JSON syntax: files beyond the limits are refused at once") {
    CHECK(only_message(std::string((4U << 20U) + 1, ' ')) == "1:1: the file is larger than 4 MiB");
    CHECK(only_message(std::string(100'000, '[')) == "1:65: nested more than 64 levels deep");
    std::string many = "[0";
    for (int i = 0; i < 200'000; ++i) many += ",0";
    CHECK(only_message(many + "]") == "1:200000: the file holds more than 100000 values");
    std::string repeated = "{\"a\":0";
    for (int i = 0; i < 50'000; ++i) repeated += ",\"a\":0";
    const std::vector<std::string> all = messages(repeated + "}");
    CHECK(all.size() == 101);
    CHECK(all[0] == "1:8: /a: \"a\" is given twice; expected one value; the first is in line 1");
}

TEST_CASE("JSON syntax: a duplicate name inside a duplicate name is reported once") {
    const std::vector<std::string> all =
        messages("{\"a\": 1,\n\"a\": {\"b\": 1, \"b\": {\"c\": 2}, \"d\": 3}}");
    REQUIRE(all.size() > 2);
    CHECK(std::count(all.begin(), all.end(),
                     "2:1: /a: \"a\" is given twice; expected one value; the first is in line 1") == 1);
    CHECK(std::count(all.begin(), all.end(),
                     "2:15: /a/b: \"b\" is given twice; expected one value; the first is in line 2") == 1);
}

}  // namespace content_syntax_test
