// The validator behind check_schema: valijson's headers are large, and stay behind this one.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace bolt::content {

// Every value that the schema refuses, by the tokens of its JSON pointer, with the validator's own first
// words on it.
std::map<std::vector<std::string>, std::string> schema_complaints(const nlohmann::json& document);

}  // namespace bolt::content
