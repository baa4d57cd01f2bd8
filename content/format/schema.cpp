#include "content/format/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "content/format/embedded.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

using nlohmann::json;

namespace {

constexpr std::size_t max_violations = 200;  // per value

const json& resolved(const json& schema, const json& node) {
    const json* at = &node;
    while (at->contains("$ref"))
        at = &schema.at(json::json_pointer((*at)["$ref"].get_ref<const std::string&>().substr(1)));
    return *at;
}

std::string type_in_words(const json& value) {
    if (value.is_object()) return "an object {...}";
    if (value.is_array()) return "a list [...]";
    if (value.is_string()) return fmt::format("the text {}", in_quotes(value.get_ref<const std::string&>()));
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (value.is_null()) return "null";
    return fmt::format("the number {:g}", value.get<double>());
}

// The purpose of a member, as the schema describes it.
std::string purpose(const json& node) {
    for (const char* key : {"description", "title"})
        if (node.contains(key)) return node[key].get<std::string>();
    return {};
}

// Returns the written form of one unit in a property's name: "N·m" for "Nm", "mm²" for "mm2"; empty if it is
// not a unit.
std::string unit_in_words(std::string_view token) {
    constexpr std::pair<std::string_view, std::string_view> units[] = {
        {"mm", "mm"},           {"um", "µm"},   {"m", "m"},         {"Nm", "N·m"},   {"kN", "kN"},
        {"MN", "MN"},           {"GPa", "GPa"}, {"MPa", "MPa"},     {"g", "g"},      {"s", "s"},
        {"percent", "percent"}, {"deg", "deg"}, {"turns", "turns"}, {"px", "pixels"}};
    const bool squared = token.ends_with('2');
    if (squared) token.remove_suffix(1);
    for (const auto& [name, written] : units)
        if (token == name) return std::string(written) + (squared ? "²" : "");
    return {};
}

// Returns the unit at the end of a property's name: " (mm)", " (MN/mm)" for "spring_rates_MN_per_mm"; empty
// without a unit.
std::string unit_of(std::string_view name) {
    const auto take_unit = [&] {
        const std::size_t bar = name.rfind('_');
        if (bar == std::string_view::npos) return std::string{};
        std::string unit = unit_in_words(name.substr(bar + 1));
        name = name.substr(0, bar);
        return unit;
    };
    std::string unit = take_unit();
    if (unit.empty()) return {};
    if (name.ends_with("_per")) {
        name.remove_suffix(4);
        const std::string numerator = take_unit();
        unit = (numerator.empty() ? "1" : numerator) + "/" + unit;
    }
    return fmt::format(" ({})", unit);
}

std::string number_in_words(const json& node, const std::string& name) {
    std::vector<std::string> bounds;
    if (node.contains("exclusiveMinimum"))
        bounds.push_back(fmt::format("> {:g}", node["exclusiveMinimum"].get<double>()));
    if (node.contains("minimum")) bounds.push_back(fmt::format(">= {:g}", node["minimum"].get<double>()));
    if (node.contains("maximum")) bounds.push_back(fmt::format("<= {:g}", node["maximum"].get<double>()));
    const char* kind = node.value("type", std::string{}) == "integer" ? "a whole number" : "a number";
    return fmt::format("{} {}{}", kind, fmt::join(bounds, " and "), unit_of(name));
}

std::string list_in_words(const json& node) {
    const std::size_t least = node.value("minItems", std::size_t{0});
    const std::size_t most = node.value("maxItems", std::size_t{0});
    if (least > 0 && least == most) return fmt::format("a list of {} values", least);
    if (least > 0) return fmt::format("a list of {} to {} values", least, most);
    return fmt::format("a list of at most {} values", most);
}

std::string expected_text(const json& node, const std::string& name) {
    if (node.contains("enum")) {
        std::vector<std::string> names;
        for (const json& option : node["enum"]) names.push_back(option.get<std::string>());
        return names.size() == 1 ? in_quotes(names[0]) : fmt::format("one of {}", fmt::join(names, ", "));
    }
    const std::string type = node.value("type", std::string{});
    if (type == "number" || type == "integer") return number_in_words(node, name);
    if (type == "array") return list_in_words(node);
    if (type == "string") return "a text in double quotes";
    if (type == "boolean") return "true or false";
    return "an object {...}";
}

std::vector<std::string> member_names(const json& node) {
    std::vector<std::string> names;
    if (node.contains("properties"))
        for (const auto& [name, sub] : node["properties"].items()) names.push_back(name);
    return names;
}

bool right_type(const json& node, const json& value) {
    const std::string type = node.value("type", std::string(node.contains("enum") ? "string" : ""));
    return ((type == "number" || type == "integer") && value.is_number()) ||
           (type == "array" && value.is_array()) || (type == "string" && value.is_string()) ||
           (type == "boolean" && value.is_boolean()) || (type == "object" && value.is_object()) ||
           type.empty();
}

void explain_number(const json& node, const json& number, const std::string& name,
                    std::vector<SchemaViolation>& out) {
    const double value = number.get<double>();
    if (node.value("type", std::string{}) == "integer" && !number.is_number_integer()) {
        SchemaViolation mistake;
        mistake.what = fmt::format("{} is not a whole number", in_quotes(number.dump()));
        mistake.expected = number_in_words(node, name);
        out.push_back(std::move(mistake));
        return;
    }
    const bool low = (node.contains("minimum") && value < node["minimum"].get<double>()) ||
                     (node.contains("exclusiveMinimum") && value <= node["exclusiveMinimum"].get<double>());
    const bool high = node.contains("maximum") && value > node["maximum"].get<double>();
    if (!low && !high) return;
    SchemaViolation mistake;
    mistake.what = fmt::format("{:g} is too {}", value, low ? "small" : "large");
    mistake.expected = number_in_words(node, name);
    out.push_back(std::move(mistake));
}

void explain_text(const json& node, const std::string& text, std::vector<SchemaViolation>& out) {
    SchemaViolation mistake;
    if (node.contains("enum")) {
        std::vector<std::string> names;
        for (const json& option : node["enum"]) names.push_back(option.get<std::string>());
        if (std::find(names.begin(), names.end(), text) != names.end()) return;
        mistake.what = fmt::format("{} is not known here", in_quotes(text));
        mistake.expected = suggest(text, names);
    } else {
        std::size_t length = 0;  // characters, not bytes
        for (const char c : text) length += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U;
        const std::size_t least = node.value("minLength", std::size_t{0});
        const std::size_t most = node.value("maxLength", length);
        if (length >= least && length <= most) return;
        mistake.what = length < least ? "this text is empty" : fmt::format("{} is too long", in_quotes(text));
        mistake.expected = length < least ? "at least one letter" : fmt::format("at most {} letters", most);
    }
    out.push_back(std::move(mistake));
}

void explain_count(const json& node, std::size_t count, const char* least_key, const char* most_key,
                   std::vector<SchemaViolation>& out) {
    const std::size_t least = node.value(least_key, std::size_t{0});
    const std::size_t most = node.value(most_key, count);
    if (count >= least && count <= most) return;
    SchemaViolation mistake;
    mistake.what = count == 0 ? "this is empty" : fmt::format("{} values", count);
    mistake.expected = least == most   ? fmt::format("{}", least)
                       : count < least ? fmt::format("at least {}", least)
                                       : fmt::format("at most {}", most);
    out.push_back(std::move(mistake));
}

// Unknown names first, because an unknown name that is near a missing one explains both.
void explain_members(const json& schema, const json& node, const json& value,
                     std::vector<SchemaViolation>& out) {
    const std::vector<std::string> names = member_names(node);
    std::vector<std::string> absent;
    for (const std::string& name : names)
        if (!value.contains(name)) absent.push_back(name);
    std::vector<std::string> explained_names;
    if (node.contains("additionalProperties") && node["additionalProperties"] == false) {
        for (const auto& [key, member] : value.items()) {
            if (std::find(names.begin(), names.end(), key) != names.end()) continue;
            if (out.size() >= max_violations) break;
            std::string best = nearest_name(key, absent);
            if (best.empty()) best = nearest_name(key, names);
            SchemaViolation mistake;
            mistake.key = key;
            mistake.at_key = true;
            mistake.what = fmt::format("unknown property {}", in_quotes(key));
            mistake.expected = best.empty() ? suggest({}, absent.empty() ? names : absent)
                                            : fmt::format("did you mean {}?", in_quotes(best));
            mistake.unusable = best;
            if (!best.empty()) explained_names.push_back(best);
            out.push_back(std::move(mistake));
        }
    }
    for (const json& entry : node.value("required", json::array())) {
        const auto& name = entry.get_ref<const std::string&>();
        if (value.contains(name) ||
            std::find(explained_names.begin(), explained_names.end(), name) != explained_names.end())
            continue;
        const json& member = node["properties"][name];
        std::string why = purpose(member);
        if (why.empty()) why = purpose(resolved(schema, member));
        SchemaViolation mistake;
        mistake.what = fmt::format("required property {} is missing", in_quotes(name));
        mistake.expected = fmt::format("{}: {}", expected_text(resolved(schema, member), {}), why);
        mistake.unusable = name;
        out.push_back(std::move(mistake));
    }
}

}  // namespace

const json* schema_of(const json& schema, const std::vector<std::string>& tokens) {
    const json* at = &resolved(schema, schema);
    for (const std::string& token : tokens) {
        if (at->contains("properties") && (*at)["properties"].contains(token))
            at = &(*at)["properties"][token];
        else if (at->contains("items"))
            at = &(*at)["items"];
        else if (at->contains("additionalProperties") && (*at)["additionalProperties"].is_object())
            at = &(*at)["additionalProperties"];
        else
            return nullptr;
        at = &resolved(schema, *at);
    }
    return at;
}

std::vector<SchemaViolation> explain_value(const json& schema, const json& node, const json& value,
                                           const std::string& name) {
    std::vector<SchemaViolation> out;
    if (!right_type(node, value)) {
        SchemaViolation mistake;
        mistake.what = type_in_words(value) + " is not allowed here";
        mistake.expected = expected_text(node, name);
        out.push_back(std::move(mistake));
    } else if (value.is_number()) {
        explain_number(node, value, name, out);
    } else if (value.is_string()) {
        explain_text(node, value.get_ref<const std::string&>(), out);
    } else if (value.is_array()) {
        explain_count(node, value.size(), "minItems", "maxItems", out);
    } else if (value.is_object()) {
        explain_count(node, value.size(), "minProperties", "maxProperties", out);
        explain_members(schema, node, value, out);
    }
    return out;
}

using valijson::adapters::NlohmannJsonAdapter;

struct JsonSchema::Compiled {
    nlohmann::json parsed;
    valijson::Schema schema;  // cannot be moved
};

JsonSchema::JsonSchema(std::string_view text) : compiled_(std::make_unique<Compiled>()) {
    compiled_->parsed = nlohmann::json::parse(text);
    valijson::SchemaParser().populateSchema(NlohmannJsonAdapter(compiled_->parsed), compiled_->schema);
}

JsonSchema::~JsonSchema() = default;

const nlohmann::json& JsonSchema::json() const { return compiled_->parsed; }

std::map<std::vector<std::string>, std::string> validator_errors(const nlohmann::json& document,
                                                                 const JsonSchema& schema) {
    valijson::Validator validator;
    valijson::ValidationResults results;
    validator.validate(schema.compiled_->schema, NlohmannJsonAdapter(document), &results);
    std::map<std::vector<std::string>, std::string> errors_by_value;
    for (const auto& error : results) {
        // The context is "<root>", "[joints]", "[3]", ...
        std::vector<std::string> tokens;
        for (std::size_t i = 1; i < error.context.size(); ++i)
            tokens.push_back(error.context[i].substr(1, error.context[i].size() - 2));
        errors_by_value.emplace(std::move(tokens), error.description);
    }
    return errors_by_value;
}

namespace {

constexpr std::size_t max_findings = 1000;  // with more, the file is probably not an assembly

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

std::string pointer_of(const std::vector<std::string>& tokens) {
    std::string pointer;
    for (const std::string& token : tokens) pointer += "/" + pointer_token(token);
    return pointer;
}

// The name of the member that holds a value, also through lists; its suffix is the unit.
std::string name_of(const std::vector<std::string>& tokens) {
    const auto is_index = [](const std::string& token) { return token[0] >= '0' && token[0] <= '9'; };
    const auto it = std::find_if_not(tokens.rbegin(), tokens.rend(), is_index);
    return it == tokens.rend() ? std::string{} : *it;
}

bool is_inside(const std::vector<std::string>& inner, const std::vector<std::string>& outer) {
    return inner.size() > outer.size() && std::equal(outer.begin(), outer.end(), inner.begin());
}

}  // namespace

const JsonSchema& assembly_schema() {
    static const JsonSchema schema(assembly_schema_text());
    return schema;
}

SchemaFindings check_schema(const JsonDocument& document, const JsonSchema& schema) {
    SchemaFindings findings;
    // The validator also reports every parent of an invalid value. In sorted order the parts of a value
    // follow it directly.
    const std::map<std::vector<std::string>, std::string> errors_by_value =
        validator_errors(document.root(), schema);
    for (auto it = errors_by_value.begin(); it != errors_by_value.end(); ++it) {
        if (findings.errors.size() >= max_findings) {
            findings.unusable.emplace_back();  // the whole file
            break;
        }
        const auto& [tokens, validator_message] = *it;
        const std::string pointer = pointer_of(tokens);
        const json* node = schema_of(schema.json(), tokens);
        const json* value = value_at(document.root(), tokens);
        std::vector<SchemaViolation> mistakes;
        if (node != nullptr && value != nullptr)
            mistakes = explain_value(schema.json(), *node, *value, name_of(tokens));
        bool value_unusable = mistakes.empty();
        for (const SchemaViolation& m : mistakes) {
            const std::string at = m.key.empty() ? pointer : pointer + "/" + pointer_token(m.key);
            findings.errors.push_back(
                document.error(at, m.at_key ? JsonPart::key : JsonPart::value, m.what, m.expected));
            if (m.unusable.empty())
                value_unusable = value_unusable || m.key.empty();
            else
                findings.unusable.push_back(pointer + "/" + pointer_token(m.unusable));
        }
        if (mistakes.empty()) {
            const auto next = std::next(it);
            if (next != errors_by_value.end() && is_inside(next->first, tokens)) continue;  // reported there
            findings.errors.push_back(document.error(pointer, JsonPart::value, validator_message, {}));
        }
        if (value_unusable) findings.unusable.push_back(pointer);
    }
    return findings;
}

}  // namespace bolt::content
