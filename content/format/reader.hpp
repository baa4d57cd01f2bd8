// Reads values out of a document that may be partly wrong. What the schema refused reads as absent, and is
// known to be wrong, so that one mistake is not reported twice.
#pragma once

#include <initializer_list>
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

struct Node {
    const nlohmann::json* value = nullptr;  // null: not there, or not usable
    std::string pointer;
    explicit operator bool() const { return value != nullptr; }
};

template <class T>
struct Found {
    std::optional<T> value;
    std::string pointer;  // where the value stands; empty if it is not there
    explicit operator bool() const { return value.has_value(); }
    const T& operator*() const { return *value; }
    [[nodiscard]] T value_or(T fallback) const { return value.value_or(std::move(fallback)); }
};

class Reader {
  public:
    explicit Reader(const JsonDocument& document);

    // Schema mistakes first, then what report() adds; sorted by place, without repetition.
    std::vector<Error> take_errors();

    [[nodiscard]] Node root() const;
    Node member(const Node& object, std::string_view key);
    std::vector<Node> items(const Node& array) const;  // elements of an array, or members of an object
    std::optional<std::string> text(const Node& node) const;
    std::optional<double> number(const Node& node) const;
    std::optional<bool> boolean(const Node& node) const;
    std::optional<Vec3> vector(const Node& node) const;

    // Neither this value, nor what holds it, nor anything inside it was refused, and it is not missing by
    // mistake.
    [[nodiscard]] bool sound(std::string_view pointer) const;

    void report(std::string_view pointer, std::string what, std::string expected, Part part = Part::value);
    [[nodiscard]] int line(std::string_view pointer, Part part = Part::value) const {
        return document_.line(pointer, part);
    }

    // Every name that was ever asked for: a test holds it against the schema.
    [[nodiscard]] const std::set<std::string, std::less<>>& names_read() const { return names_read_; }

  private:
    const JsonDocument& document_;
    std::set<std::string, std::less<>> unusable_;
    std::vector<Error> errors_;
    std::set<std::string, std::less<>> names_read_;
};

// Objects laid over each other: a value is read from the first that has it. A joint type under its patches.
class Layers {
  public:
    Layers(Reader& reader, std::vector<Node> objects);

    Found<double> number(std::string_view key) const;
    Found<std::string> text(std::string_view key) const;
    Found<bool> boolean(std::string_view key) const;
    [[nodiscard]] Node find(std::string_view key) const;
    [[nodiscard]] Layers inside(std::string_view key) const;
    [[nodiscard]] const std::vector<Node>& objects() const { return objects_; }
    [[nodiscard]] bool sound() const;
    // What is read for each of these keys is what the author meant, be it a value or none.
    [[nodiscard]] bool known(std::initializer_list<std::string_view> keys) const;
    [[nodiscard]] Reader& reader() const { return reader_; }

  private:
    Reader& reader_;
    std::vector<Node> objects_;  // those that are there
    bool whole_ = true;          // none of them was refused
};

}  // namespace bolt::content
