#include "content/format/schema.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "content/format/embedded.hpp"
#include "content/format/json_pointer.hpp"
#include "content/format/schema_explain.hpp"
#include "content/format/schema_validator.hpp"

namespace bolt::content {

using nlohmann::json;

namespace {

constexpr std::size_t most_findings = 1000;  // a file with more is not the file that was meant

const json* value_at(const json& root, const std::vector<std::string>& tokens) {
    const json* at = &root;
    for (const std::string& token : tokens) {
        if (at->is_object() && at->contains(token))
            at = &(*at)[token];
        else if (at->is_array() &&
                 std::all_of(token.begin(), token.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
                 !token.empty() && token.size() < 8 && std::stoul(token) < at->size())
            at = &(*at)[std::stoul(token)];
        else
            return nullptr;
    }
    return at;
}

std::string joined(const std::vector<std::string>& tokens) {
    std::string pointer;
    for (const std::string& token : tokens) pointer += "/" + pointer_token(token);
    return pointer;
}

// The member that holds a value, also through lists: its name ends in the unit.
std::string name_of(const std::vector<std::string>& tokens) {
    const auto is_index = [](const std::string& token) { return token[0] >= '0' && token[0] <= '9'; };
    const auto it = std::find_if_not(tokens.rbegin(), tokens.rend(), is_index);
    return it == tokens.rend() ? std::string{} : *it;
}

bool is_inside(const std::vector<std::string>& inner, const std::vector<std::string>& outer) {
    return inner.size() > outer.size() && std::equal(outer.begin(), outer.end(), inner.begin());
}

}  // namespace

const json& schema_json() {
    static const json schema = json::parse(schema_text());
    return schema;
}

SchemaFindings check_schema(const JsonDocument& document) {
    SchemaFindings findings;
    // The validator also reports every parent of a wrong value. Sorted, what is inside a value follows it at
    // once.
    const std::map<std::vector<std::string>, std::string> complaints = schema_complaints(document.root());
    for (auto it = complaints.begin(); it != complaints.end(); ++it) {
        if (findings.errors.size() >= most_findings) {
            findings.unusable.emplace_back();  // the whole file
            break;
        }
        const auto& [tokens, complaint] = *it;
        const std::string pointer = joined(tokens);
        const json* node = schema_of(schema_json(), tokens);
        const json* value = value_at(document.root(), tokens);
        std::vector<SchemaMistake> mistakes;
        if (node != nullptr && value != nullptr)
            mistakes = explain_value(schema_json(), *node, *value, name_of(tokens));
        bool whole = mistakes.empty();
        for (const SchemaMistake& m : mistakes) {
            const std::string at = m.key.empty() ? pointer : pointer + "/" + pointer_token(m.key);
            findings.errors.push_back(
                document.error(at, m.at_key ? Part::key : Part::value, m.what, m.expected));
            if (m.unusable.empty())
                whole = whole || m.key.empty();
            else
                findings.unusable.push_back(pointer + "/" + pointer_token(m.unusable));
        }
        if (mistakes.empty()) {
            const auto next = std::next(it);
            if (next != complaints.end() && is_inside(next->first, tokens)) continue;  // said there
            findings.errors.push_back(document.error(pointer, Part::value, complaint, {}));
        }
        if (whole) findings.unusable.push_back(pointer);
    }
    return findings;
}

}  // namespace bolt::content
