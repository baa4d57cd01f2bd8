// A JSON document that records the position of every key and value, JSON pointers (RFC 6901: "/joints/3/id"),
// and helpers for error messages.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

// One reference token, escaped: "a/b" becomes "a~1b".
std::string pointer_token(std::string_view key);

// All reference tokens, unescaped.
std::vector<std::string> pointer_tokens(std::string_view pointer);

// The last reference token, unescaped; empty for the whole document.
std::string last_token(std::string_view pointer);

// Quotes a text of the file for a message: truncated if long, without control characters.
std::string in_quotes(std::string_view text);

// Returns the known name nearest to `name`; empty if none is close enough or several are equally close.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

// Returns Error::expected for an unknown name: "did you mean "x"?" or "one of a, b, c".
std::string suggest(std::string_view name, std::span<const std::string> known);

// Sorts by line and column; errors at the same position keep their order.
void sort_by_position(std::vector<Error>& errors);

// Limits of a content file, far above what authors need; they bound the cost of a hostile file.
inline constexpr std::size_t json_size_limit = 4U << 20U;  // bytes
inline constexpr std::size_t json_depth_limit = 64;
inline constexpr std::size_t json_value_limit = 100'000;
inline constexpr std::size_t json_key_limit = 128;  // bytes

enum class JsonPart : std::uint8_t { key, value };

// A parsed JSON text with the positions of its keys and values, so that errors found later can name line and
// column.
class JsonDocument {
  public:
    // Appends errors to `errors`. Returns null if the text is not JSON. A document with repeated keys is
    // returned with an error; the first value of a key counts.
    static std::unique_ptr<JsonDocument> parse(std::string_view text, std::string_view file,
                                               std::vector<Error>& errors);
    JsonDocument(const JsonDocument&) = delete;
    JsonDocument& operator=(const JsonDocument&) = delete;
    ~JsonDocument();

    [[nodiscard]] const nlohmann::json& root() const;

    // Offset of the key or value at a JSON pointer; of its nearest existing parent if there is no such value.
    [[nodiscard]] std::size_t offset(std::string_view pointer, JsonPart part = JsonPart::value) const;

    // An error at a JSON pointer, with line and column. Columns count code points, as editors do; a tab is
    // one.
    [[nodiscard]] Error error(std::string_view pointer, JsonPart part, std::string what,
                              std::string expected) const;

    [[nodiscard]] int line(std::string_view pointer, JsonPart part = JsonPart::value) const;

  private:
    friend class JsonBuilder;
    struct Entry;
    struct Content;
    JsonDocument(std::string_view text, std::string_view file);
    [[nodiscard]] Error error_at(std::size_t offset, std::string what, std::string expected) const;
    [[nodiscard]] std::size_t line_start(std::size_t offset) const;
    [[nodiscard]] std::string place(std::size_t offset) const;  // "line:column"

    std::unique_ptr<Content> content_;
};

}  // namespace bolt::content
