// What one value has against one node of a JSON Schema (draft-07, the keywords that our schema uses).
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "content/format/json_document.hpp"

namespace bolt::content {

struct SchemaMistake {
    std::string key;      // member that it is about; empty: the value itself
    bool at_key = false;  // stands at the member's name, not at the value
    std::string what;
    std::string expected;
    std::string unusable;  // member that cannot be used because of it; may be empty
};

// The schema of the value at `tokens`, references resolved; null where the schema says nothing.
const nlohmann::json* schema_of(const nlohmann::json& schema, const std::vector<std::string>& tokens);

// Only what is wrong with the value itself and the names of its members, not what is wrong inside them.
// `name` is the member that holds the value: its last part is the unit.
std::vector<SchemaMistake> explain_value(const nlohmann::json& schema, const nlohmann::json& node,
                                         const nlohmann::json& value, const std::string& name);

// The validator behind check_schema: valijson's headers are large, and stay behind this one.

// Every value that the schema refuses, by the tokens of its JSON pointer, with the validator's own first
// words on it.
std::map<std::vector<std::string>, std::string> schema_complaints(const nlohmann::json& document);

// Checks a document against the assembly's JSON Schema and says every mistake in an author's words.

// The schema, parsed.
const nlohmann::json& schema_json();

struct SchemaFindings {
    std::vector<Error> errors;
    // JSON pointers of values that are wrong or missing: nothing that depends on them can be judged.
    std::vector<std::string> unusable;
};

SchemaFindings check_schema(const JsonDocument& document);

}  // namespace bolt::content
