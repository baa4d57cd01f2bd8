// What the content tests share: texts to break, and messages as an author reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"

namespace content_test {

// assembly.json of an assembly under content/assemblies.
std::string shipped(std::string_view name);

// A small file without mistakes whose lines and columns stay as they are, whatever is shipped:
// tests/data/cover.json.
std::string cover();

// A small file without mistakes that uses every property of the schema.
std::string_view everything();

// `text` with the first `from` replaced; fails the test if there is none.
std::string edited(std::string text, std::string_view from, std::string_view to);

// The messages of parse_assembly without the file name: "line:column: pointer: what; expected".
std::vector<std::string> messages(std::string_view text);

int count_lines(std::string_view text);

}  // namespace content_test
