// JSON pointers (RFC 6901): "/joints/3/id".
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

// How messages show the names of a file, and what an author may have meant by one that is not there.

// A text of the file as a message shows it: quoted, cut when long, without control characters.
std::string in_quotes(std::string_view text);

// The one known name that is near enough to be what was meant; empty if none is, or several are as near.
std::string meant(std::string_view name, std::span<const std::string> known);

// "did you mean "x"?", or "expected one of a, b, c".
std::string suggest(std::string_view name, std::span<const std::string> known);

// A JSON text that remembers where every key and value stands, so that a mistake found later can be pointed
// at.

// What a content file may be at most: bounds that no author meets, and that keep a hostile file cheap.
inline constexpr std::size_t json_size_limit = 4U << 20U;  // bytes
inline constexpr std::size_t json_depth_limit = 64;
inline constexpr std::size_t json_value_limit = 100'000;
inline constexpr std::size_t json_key_limit = 128;  // bytes

enum class Part : std::uint8_t { key, value };

class JsonDocument {
  public:
    // Appends what is wrong to `errors`. Null if the text is no JSON; a document with repeated keys is still
    // given, the first of them counts.
    static std::unique_ptr<JsonDocument> parse(std::string_view text, std::string_view file,
                                               std::vector<Error>& errors);
    JsonDocument(const JsonDocument&) = delete;
    JsonDocument& operator=(const JsonDocument&) = delete;
    ~JsonDocument();

    [[nodiscard]] const nlohmann::json& root() const;

    // Byte where the key or value of a JSON pointer begins; of the nearest parent that is there, if it is
    // not.
    [[nodiscard]] std::size_t offset(std::string_view pointer, Part part = Part::value) const;

    // A mistake at a JSON pointer, with its line and column. Columns count characters as an editor does: code
    // points, a tab is one.
    [[nodiscard]] Error error(std::string_view pointer, Part part, std::string what,
                              std::string expected) const;

    [[nodiscard]] int line(std::string_view pointer, Part part = Part::value) const;

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
