// What one value has against one node of a JSON Schema (draft-07, the keywords that our schema uses).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

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

}  // namespace bolt::content
