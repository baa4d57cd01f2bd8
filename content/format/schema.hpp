// Checks a document against the assembly's JSON Schema and says every mistake in an author's words.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "content/format/json_document.hpp"

namespace bolt::content {

// The schema, parsed.
const nlohmann::json& schema_json();

struct SchemaFindings {
    std::vector<Error> errors;
    // JSON pointers of values that are wrong or missing: nothing that depends on them can be judged.
    std::vector<std::string> unusable;
};

SchemaFindings check_schema(const JsonDocument& document);

}  // namespace bolt::content
