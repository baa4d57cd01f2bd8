#include "content/format/json_document.hpp"

#include <doctest/doctest.h>

#include <functional>

#include <nlohmann/json.hpp>

#include "content/format/json_syntax.hpp"
#include "support.hpp"

namespace content_json_document_test {

using namespace bolt::content;
using nlohmann::json;

namespace {

// Checks that every key and value of a text is found at its position.
void check_positions(std::string_view text) {
    std::vector<bolt::Error> errors;
    const auto document = JsonDocument::parse(text, "f", errors);
    REQUIRE(document);
    REQUIRE(errors.empty());
    const json reference = json::parse(text);
    CHECK(document->root() == reference);
    const std::function<void(const json&, const std::string&)> visit = [&](const json& value,
                                                                           const std::string& at) {
        const std::size_t begin = document->offset(at);
        CAPTURE(at);
        if (value.is_structured()) {
            REQUIRE(text[begin] == (value.is_object() ? '{' : '['));
        } else {
            REQUIRE(json::parse(text.substr(begin, token_end(text, begin) - begin)) == value);
            return;
        }
        for (const auto& [key, member] : value.items()) {
            const std::string pointer = at + "/" + pointer_token(key);
            if (value.is_object()) {
                const std::size_t name = document->offset(pointer, JsonPart::key);
                REQUIRE(json::parse(text.substr(name, token_end(text, name) - name)) == key);
            }
            visit(member, pointer);
        }
    };
    visit(reference, "");
}

}  // namespace

TEST_CASE("JSON document: every key and value is found at its position") {
    check_positions(content_test::shipped("zq350"));
    check_positions(content_test::everything());
    check_positions("[]");
    check_positions("\t-1.5e-3 ");
    check_positions(
        "\xEF\xBB\xBF{\"a/b\": {\"~\": [[], {}, [0, -0, 1E2, 0.5]]}, \"0\" :\r\n\"\\\"\\u00b5\\\\\", "
        "\"µ\":null}");
}

TEST_CASE("JSON document: the position of a missing value is that of its nearest parent") {
    std::vector<bolt::Error> errors;
    const auto document = JsonDocument::parse("{\n \"a\": {\"b\": [1,\n 2]}}", "f", errors);
    REQUIRE(document);
    CHECK(document->offset("/a/b/1") == 19);
    CHECK(document->line("/a/b/1") == 3);
    CHECK(document->offset("/a/b/7") == document->offset("/a/b"));
    CHECK(document->offset("/a/c", JsonPart::key) == document->offset("/a"));
    CHECK(document->offset("/x/y") == 0);
    CHECK(document->error("/a/b/1", JsonPart::value, "odd", "expected 3").message() ==
          "f:3:2: /a/b/1: odd; expected 3");
}

TEST_CASE("JSON document: JSON pointers are escaped by RFC 6901") {
    CHECK(pointer_token("a/b~c") == "a~1b~0c");
    CHECK(pointer_tokens("/a~1b~0c/0//x") == std::vector<std::string>{"a/b~c", "0", "", "x"});
    CHECK(pointer_tokens("").empty());
}

TEST_CASE("JSON document: integers beyond 2^53 are numbers") {
    std::vector<bolt::Error> errors;
    const auto document =
        JsonDocument::parse("[18446744073709551615, -9223372036854775808, 9007199254740992]", "f", errors);
    REQUIRE(document);
    CHECK(document->root()[0].get<double>() == 18446744073709551615.0);
    CHECK(document->root()[1].get<double>() == -9223372036854775808.0);
    CHECK(document->root()[2].is_number_integer());
}

}  // namespace content_json_document_test
