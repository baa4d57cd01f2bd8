#include "content/format/reader.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "content/format/json_document.hpp"

namespace bolt::content {

using nlohmann::json;

Reader::Reader(const JsonDocument& document) : document_(document) {
    SchemaFindings findings = check_schema(document);
    errors_ = std::move(findings.errors);
    unusable_.insert(findings.unusable.begin(), findings.unusable.end());
}

std::vector<Error> Reader::take_errors() {
    const auto key = [](const Error& e) { return std::tie(e.line, e.column, e.pointer, e.what, e.expected); };
    std::stable_sort(errors_.begin(), errors_.end(),
                     [&](const Error& a, const Error& b) { return key(a) < key(b); });
    errors_.erase(std::unique(errors_.begin(), errors_.end(),
                              [&](const Error& a, const Error& b) { return key(a) == key(b); }),
                  errors_.end());
    return std::move(errors_);
}

Node Reader::root() const {
    const bool usable = document_.root().is_object() && !unusable_.contains("");
    return {usable ? &document_.root() : nullptr, ""};
}

Node Reader::member(const Node& object, std::string_view key) {
    if (!names_read_.contains(key)) names_read_.emplace(key);
    Node node{nullptr, object.pointer + "/" + pointer_token(key)};
    if (!object || !object.value->is_object() || unusable_.contains(node.pointer)) return node;
    const auto it = object.value->find(key);
    if (it != object.value->end()) node.value = &*it;
    return node;
}

std::vector<Node> Reader::items(const Node& array) const {
    std::vector<Node> nodes;
    if (!array || !array.value->is_structured()) return nodes;
    for (const auto& [key, value] : array.value->items()) {
        Node node{&value, array.pointer + "/" + pointer_token(key)};
        if (unusable_.contains(node.pointer)) node.value = nullptr;
        nodes.push_back(std::move(node));
    }
    return nodes;
}

std::optional<std::string> Reader::text(const Node& node) const {
    if (!node || !node.value->is_string()) return std::nullopt;
    return node.value->get<std::string>();
}

std::optional<double> Reader::number(const Node& node) const {
    if (!node || !node.value->is_number()) return std::nullopt;
    return node.value->get<double>();
}

std::optional<bool> Reader::boolean(const Node& node) const {
    if (!node || !node.value->is_boolean()) return std::nullopt;
    return node.value->get<bool>();
}

std::optional<Vec3> Reader::vector(const Node& node) const {
    const std::vector<Node> parts = items(node);
    if (parts.size() != 3) return std::nullopt;
    Vec3 v{0.0};
    for (int i = 0; i < 3; ++i) {
        const auto part = number(parts[static_cast<std::size_t>(i)]);
        if (!part) return std::nullopt;
        v[i] = *part;
    }
    return v;
}

bool Reader::sound(std::string_view pointer) const {
    for (std::size_t bar = pointer.find('/'); bar != std::string_view::npos; bar = pointer.find('/', bar + 1))
        if (unusable_.contains(pointer.substr(0, bar))) return false;
    const auto it = unusable_.lower_bound(pointer);
    for (auto inner = it; inner != unusable_.end() && inner->starts_with(pointer); ++inner)
        if (inner->size() == pointer.size() || (*inner)[pointer.size()] == '/') return false;
    return true;
}

void Reader::report(std::string_view pointer, std::string what, std::string expected, Part part) {
    errors_.push_back(document_.error(pointer, part, std::move(what), std::move(expected)));
}

Layers::Layers(Reader& reader, std::vector<Node> objects) : reader_(reader), objects_(std::move(objects)) {
    whole_ = std::all_of(objects_.begin(), objects_.end(),
                         [&](const Node& node) { return node || reader_.sound(node.pointer); });
    std::erase_if(objects_, [](const Node& node) { return !node; });
}

Node Layers::find(std::string_view key) const {
    Node node;
    for (const Node& object : objects_) {
        node = reader_.member(object, key);
        if (node || !reader_.sound(node.pointer))
            return node;  // a value that is wrong still hides those below it
    }
    return node;
}

Layers Layers::inside(std::string_view key) const {
    std::vector<Node> inner;
    for (const Node& object : objects_) inner.push_back(reader_.member(object, key));
    Layers result(reader_, std::move(inner));
    result.whole_ = result.whole_ && whole_;
    return result;
}

Found<double> Layers::number(std::string_view key) const {
    const Node node = find(key);
    return {reader_.number(node), node ? node.pointer : std::string{}};
}

Found<std::string> Layers::text(std::string_view key) const {
    const Node node = find(key);
    return {reader_.text(node), node ? node.pointer : std::string{}};
}

Found<bool> Layers::boolean(std::string_view key) const {
    const Node node = find(key);
    return {reader_.boolean(node), node ? node.pointer : std::string{}};
}

bool Layers::known(std::initializer_list<std::string_view> keys) const {
    return whole_ && std::all_of(keys.begin(), keys.end(),
                                 [&](std::string_view key) { return reader_.sound(find(key).pointer); });
}

bool Layers::sound() const {
    return std::all_of(objects_.begin(), objects_.end(),
                       [&](const Node& n) { return reader_.sound(n.pointer); });
}

}  // namespace bolt::content
