// Shared by the content tests: correct files to edit, and the messages as an author reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"

namespace content_test {

// assembly.json of an assembly under content/assemblies.
std::string shipped(std::string_view name);

// tests/data/cover.json: a small correct file whose lines and columns do not depend on the shipped
// assemblies.
std::string cover();

// A small correct file that uses every property of the schema.
std::string_view everything();

// Returns `text` with the first `from` replaced; fails the test if there is none.
std::string edited(std::string text, std::string_view from, std::string_view to);

// The messages of parse_assembly without the file name: "line:column: pointer: what; expected".
std::vector<std::string> messages(std::string_view text);

int count_lines(std::string_view text);

}  // namespace content_test
