// Validation of a document against a JSON Schema (draft-07, the keywords that our schemas use). The errors
// are worded for authors.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "content/format/json_document.hpp"

namespace bolt::content {

// A schema, parsed, and compiled for the validator. Its text must be a valid schema.
class JsonSchema {
  public:
    explicit JsonSchema(std::string_view text);
    JsonSchema(const JsonSchema&) = delete;
    JsonSchema& operator=(const JsonSchema&) = delete;
    ~JsonSchema();
    [[nodiscard]] const nlohmann::json& json() const;

  private:
    friend std::map<std::vector<std::string>, std::string> validator_errors(const nlohmann::json& document,
                                                                            const JsonSchema& schema);
    struct Compiled;
    std::unique_ptr<Compiled> compiled_;
};

// The schema of assembly.json.
const JsonSchema& assembly_schema();

// A violation of the schema by one value.
struct SchemaViolation {
    std::string key;      // member concerned; empty: the value itself
    bool at_key = false;  // reported at the member's name instead of its value
    std::string what;
    std::string expected;
    std::string unusable;  // member that cannot be used as a consequence; may be empty
};

// The schema node of the value at `tokens` with references resolved; null if the schema has none.
const nlohmann::json* schema_of(const nlohmann::json& schema, const std::vector<std::string>& tokens);

// Explains what is wrong with the value itself and with the names of its members, but not with the values of
// the members. `name` is the member that holds the value; its suffix is the unit.
std::vector<SchemaViolation> explain_value(const nlohmann::json& schema, const nlohmann::json& node,
                                           const nlohmann::json& value, const std::string& name);

// All values that violate the schema, by the tokens of their JSON pointers, each with the validator's first
// message.
std::map<std::vector<std::string>, std::string> validator_errors(const nlohmann::json& document,
                                                                 const JsonSchema& schema);

struct SchemaFindings {
    std::vector<Error> errors;
    // JSON pointers of values that are invalid or missing; checks that depend on them must be skipped.
    std::vector<std::string> unusable;
};

SchemaFindings check_schema(const JsonDocument& document, const JsonSchema& schema);

}  // namespace bolt::content
