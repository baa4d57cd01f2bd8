// Reads values from a JSON document that may be partly invalid. Values that violate the schema read as absent
// and are marked as invalid, so that one mistake is not reported twice.
#pragma once

#include <initializer_list>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "content/format/json_document.hpp"
#include "content/format/schema.hpp"
#include "engine/base/math.hpp"

namespace bolt::content {

struct JsonNode {
    const nlohmann::json* value = nullptr;  // null: missing or unusable
    std::string pointer;
    explicit operator bool() const { return value != nullptr; }
};

template <class T>
struct Located {
    std::optional<T> value;
    std::string pointer;  // of the value; empty if it is missing
    explicit operator bool() const { return value.has_value(); }
    const T& operator*() const { return *value; }
    [[nodiscard]] T value_or(T fallback) const { return value.value_or(std::move(fallback)); }
};

class JsonReader {
  public:
    explicit JsonReader(const JsonDocument& document, const JsonSchema& schema = assembly_schema());

    // Returns the schema errors and those added by report(), sorted by position, without duplicates.
    std::vector<Error> take_errors();

    [[nodiscard]] JsonNode root() const;
    // The member of an object; the node has no value if the member is missing or unusable.
    JsonNode member(const JsonNode& object, std::string_view key);
    std::vector<JsonNode> items(
        const JsonNode& array) const;  // elements of an array, or members of an object
    std::optional<std::string> text(const JsonNode& node) const;
    std::map<std::string, std::string> texts(const JsonNode& object) const;  // its texts, by member name
    std::optional<double> number(const JsonNode& node) const;
    std::optional<bool> boolean(const JsonNode& node) const;
    std::optional<Vec3> vector(const JsonNode& node) const;

    // Returns true if this value, its parents and its parts conform to the schema. A missing value is valid
    // unless the schema requires it or an unknown property is probably its misspelled name.
    [[nodiscard]] bool is_valid(std::string_view pointer) const;

    void report(std::string_view pointer, std::string what, std::string expected,
                JsonPart part = JsonPart::value);
    [[nodiscard]] int line(std::string_view pointer, JsonPart part = JsonPart::value) const {
        return document_.line(pointer, part);
    }

    // All member names that were ever read; a test compares them with the schema.
    [[nodiscard]] const std::set<std::string, std::less<>>& names_read() const { return names_read_; }

  private:
    const JsonDocument& document_;
    std::set<std::string, std::less<>> unusable_;
    std::vector<Error> errors_;
    std::set<std::string, std::less<>> names_read_;
};

// Objects in layers: a member is read from the first object that has it. For example, the patch of a variant
// precedes the joint type.
class LayeredObject {
  public:
    LayeredObject(JsonReader& reader, std::vector<JsonNode> objects);

    Located<double> number(std::string_view key) const;
    Located<std::string> text(std::string_view key) const;
    Located<bool> boolean(std::string_view key) const;
    [[nodiscard]] JsonNode find(std::string_view key) const;
    [[nodiscard]] LayeredObject member_layers(std::string_view key) const;
    [[nodiscard]] const std::vector<JsonNode>& objects() const { return objects_; }
    [[nodiscard]] bool is_valid() const;
    // Returns true if each of these members is valid (JsonReader::is_valid). An absent member can be valid.
    [[nodiscard]] bool all_valid(std::initializer_list<std::string_view> keys) const;
    [[nodiscard]] JsonReader& reader() const { return reader_; }

  private:
    JsonReader& reader_;
    std::vector<JsonNode> objects_;  // the existing ones
    bool all_valid_ = true;          // none of the objects violates the schema
};

}  // namespace bolt::content
