#include "content/format/reader.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "content/format/json_document.hpp"

namespace bolt::content {

using nlohmann::json;

JsonReader::JsonReader(const JsonDocument& document, const JsonSchema& schema) : document_(document) {
    SchemaFindings findings = check_schema(document, schema);
    errors_ = std::move(findings.errors);
    unusable_.insert(findings.unusable.begin(), findings.unusable.end());
}

std::vector<Error> JsonReader::take_errors() {
    const auto key = [](const Error& e) { return std::tie(e.line, e.column, e.pointer, e.what, e.expected); };
    std::stable_sort(errors_.begin(), errors_.end(),
                     [&](const Error& a, const Error& b) { return key(a) < key(b); });
    errors_.erase(std::unique(errors_.begin(), errors_.end(),
                              [&](const Error& a, const Error& b) { return key(a) == key(b); }),
                  errors_.end());
    return std::move(errors_);
}

JsonNode JsonReader::root() const {
    const bool usable = document_.root().is_object() && !unusable_.contains("");
    return {usable ? &document_.root() : nullptr, ""};
}

JsonNode JsonReader::member(const JsonNode& object, std::string_view key) {
    if (!names_read_.contains(key)) names_read_.emplace(key);
    JsonNode node{nullptr, object.pointer + "/" + pointer_token(key)};
    if (!object || !object.value->is_object() || unusable_.contains(node.pointer)) return node;
    const auto it = object.value->find(key);
    if (it != object.value->end()) node.value = &*it;
    return node;
}

std::vector<JsonNode> JsonReader::items(const JsonNode& array) const {
    std::vector<JsonNode> nodes;
    if (!array || !array.value->is_structured()) return nodes;
    for (const auto& [key, value] : array.value->items()) {
        JsonNode node{&value, array.pointer + "/" + pointer_token(key)};
        if (unusable_.contains(node.pointer)) node.value = nullptr;
        nodes.push_back(std::move(node));
    }
    return nodes;
}

std::optional<std::string> JsonReader::text(const JsonNode& node) const {
    if (!node || !node.value->is_string()) return std::nullopt;
    return node.value->get<std::string>();
}

std::map<std::string, std::string> JsonReader::texts(const JsonNode& object) const {
    std::map<std::string, std::string> texts;
    for (const JsonNode& item : items(object))
        if (auto member = text(item)) texts[last_token(item.pointer)] = *std::move(member);
    return texts;
}

std::optional<double> JsonReader::number(const JsonNode& node) const {
    if (!node || !node.value->is_number()) return std::nullopt;
    return node.value->get<double>();
}

std::optional<bool> JsonReader::boolean(const JsonNode& node) const {
    if (!node || !node.value->is_boolean()) return std::nullopt;
    return node.value->get<bool>();
}

std::optional<Vec3> JsonReader::vector(const JsonNode& node) const {
    const std::vector<JsonNode> parts = items(node);
    if (parts.size() != 3) return std::nullopt;
    Vec3 v{0.0};
    for (int i = 0; i < 3; ++i) {
        const auto part = number(parts[static_cast<std::size_t>(i)]);
        if (!part) return std::nullopt;
        v[i] = *part;
    }
    return v;
}

bool JsonReader::is_valid(std::string_view pointer) const {
    for (std::size_t bar = pointer.find('/'); bar != std::string_view::npos; bar = pointer.find('/', bar + 1))
        if (unusable_.contains(pointer.substr(0, bar))) return false;
    const auto it = unusable_.lower_bound(pointer);
    for (auto inner = it; inner != unusable_.end() && inner->starts_with(pointer); ++inner)
        if (inner->size() == pointer.size() || (*inner)[pointer.size()] == '/') return false;
    return true;
}

void JsonReader::report(std::string_view pointer, std::string what, std::string expected, JsonPart part) {
    errors_.push_back(document_.error(pointer, part, std::move(what), std::move(expected)));
}

LayeredObject::LayeredObject(JsonReader& reader, std::vector<JsonNode> objects)
    : reader_(reader), objects_(std::move(objects)) {
    all_valid_ = std::all_of(objects_.begin(), objects_.end(),
                             [&](const JsonNode& node) { return node || reader_.is_valid(node.pointer); });
    std::erase_if(objects_, [](const JsonNode& node) { return !node; });
}

JsonNode LayeredObject::find(std::string_view key) const {
    JsonNode node;
    for (const JsonNode& object : objects_) {
        node = reader_.member(object, key);
        if (node || !reader_.is_valid(node.pointer))
            return node;  // an invalid value hides those of the layers below
    }
    return node;
}

LayeredObject LayeredObject::member_layers(std::string_view key) const {
    std::vector<JsonNode> inner;
    for (const JsonNode& object : objects_) inner.push_back(reader_.member(object, key));
    LayeredObject result(reader_, std::move(inner));
    result.all_valid_ = result.all_valid_ && all_valid_;
    return result;
}

Located<double> LayeredObject::number(std::string_view key) const {
    const JsonNode node = find(key);
    return {reader_.number(node), node ? node.pointer : std::string{}};
}

Located<std::string> LayeredObject::text(std::string_view key) const {
    const JsonNode node = find(key);
    return {reader_.text(node), node ? node.pointer : std::string{}};
}

Located<bool> LayeredObject::boolean(std::string_view key) const {
    const JsonNode node = find(key);
    return {reader_.boolean(node), node ? node.pointer : std::string{}};
}

bool LayeredObject::all_valid(std::initializer_list<std::string_view> keys) const {
    return all_valid_ && std::all_of(keys.begin(), keys.end(), [&](std::string_view key) {
               return reader_.is_valid(find(key).pointer);
           });
}

bool LayeredObject::is_valid() const {
    return std::all_of(objects_.begin(), objects_.end(),
                       [&](const JsonNode& n) { return reader_.is_valid(n.pointer); });
}

}  // namespace bolt::content
