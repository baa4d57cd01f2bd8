// Replaces one occurrence in a text; the test fails if there is none.
#pragma once

#include <doctest/doctest.h>

#include <string>

namespace bolt::test {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace bolt::test
