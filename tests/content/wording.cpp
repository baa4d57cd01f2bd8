#include "content/format/json_document.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace content_wording_test {

using bolt::content::in_quotes;
using bolt::content::nearest_name;
using bolt::content::suggest;

TEST_CASE("Wording: a name is suggested only if exactly one is near") {
    const std::vector<std::string> ids = {"B1", "B2", "F10"};
    CHECK(nearest_name("b1", ids) == "B1");
    CHECK(nearest_name("F1O", ids) == "F10");
    CHECK(nearest_name("B3", ids).empty());  // equally near to B1 and B2
    CHECK(nearest_name("x", ids).empty());
    CHECK(nearest_name("", ids).empty());
    CHECK(suggest("b1", ids) == "did you mean \"B1\"?");
    CHECK(suggest("B3", ids) == "one of B1, B2, F10");
    CHECK(suggest("x", std::vector<std::string>{"only"}) == "\"only\"");
}

TEST_CASE("Wording: a long list of names is cut") {
    std::vector<std::string> many;
    for (int i = 100; i < 200; ++i) many.push_back("joint_" + std::to_string(i));
    const std::string text = suggest("bolt", many);
    CHECK(text.starts_with("one of joint_100, joint_101"));
    CHECK(text.ends_with("joint_119, ..."));
}

TEST_CASE("Wording: a quoted text is cut between characters and shows no control characters") {
    CHECK(in_quotes("a\nb\x7F") == "\"a?b?\"");
    const std::string long_text = std::string(59, 'x') + "µµ";
    CHECK(in_quotes(long_text) == "\"" + std::string(59, 'x') + "\"...");
}

}  // namespace content_wording_test
