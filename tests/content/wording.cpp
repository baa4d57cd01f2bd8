#include "content/format/json_document.hpp"

#include <doctest/doctest.h>

#include <vector>

using bolt::content::in_quotes;
using bolt::content::meant;
using bolt::content::suggest;

TEST_CASE("Wording: one near name is what was meant; several or none are not") {
    const std::vector<std::string> ids = {"B1", "B2", "F10"};
    CHECK(meant("b1", ids) == "B1");
    CHECK(meant("F1O", ids) == "F10");
    CHECK(meant("B3", ids).empty());  // as near to B1 as to B2
    CHECK(meant("x", ids).empty());
    CHECK(meant("", ids).empty());
    CHECK(suggest("b1", ids) == "did you mean \"B1\"?");
    CHECK(suggest("B3", ids) == "expected one of B1, B2, F10");
    CHECK(suggest("x", std::vector<std::string>{"only"}) == "expected \"only\"");
}

TEST_CASE("Wording: a long list of names is cut") {
    std::vector<std::string> many;
    for (int i = 100; i < 200; ++i) many.push_back("joint_" + std::to_string(i));
    const std::string text = suggest("bolt", many);
    CHECK(text.starts_with("expected one of joint_100, joint_101"));
    CHECK(text.ends_with("joint_119, ..."));
}

TEST_CASE("Wording: a text in a message is cut between characters and shows no control characters") {
    CHECK(in_quotes("a\nb\x7F") == "\"a?b?\"");
    const std::string long_text = std::string(59, 'x') + "µµ";
    CHECK(in_quotes(long_text) == "\"" + std::string(59, 'x') + "\"...");
}
