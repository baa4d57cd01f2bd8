#include "content/format/schema_validator.hpp"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "content/format/schema.hpp"

namespace bolt::content {

using valijson::adapters::NlohmannJsonAdapter;

namespace {

struct CompiledSchema {
    valijson::Schema schema;  // cannot be moved
    CompiledSchema() { valijson::SchemaParser().populateSchema(NlohmannJsonAdapter(schema_json()), schema); }
};

}  // namespace

std::map<std::vector<std::string>, std::string> schema_complaints(const nlohmann::json& document) {
    static const CompiledSchema compiled;
    valijson::Validator validator;
    valijson::ValidationResults results;
    validator.validate(compiled.schema, NlohmannJsonAdapter(document), &results);
    std::map<std::vector<std::string>, std::string> complaints;
    for (const auto& error : results) {
        // The context is "<root>", "[joints]", "[3]", ...
        std::vector<std::string> tokens;
        for (std::size_t i = 1; i < error.context.size(); ++i)
            tokens.push_back(error.context[i].substr(1, error.context[i].size() - 2));
        complaints.emplace(std::move(tokens), error.description);
    }
    return complaints;
}

}  // namespace bolt::content
