// Explains in plain words why a text is not JSON, for authors.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace bolt::content {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct SyntaxError {
    std::size_t offset = 0;  // byte offset
    std::string what;
    std::string expected;
};

// The last token that the parser read before it stopped, besides commas and colons: none, `{`, `[`, a key, a
// value in an object, a value in an array, or the whole document.
enum class ParserState { start, object_open, array_open, key, object_value, array_value, end };

struct ParserStop {
    std::size_t end = 0;  // byte after the last valid token
    ParserState last_token = ParserState::start;
    std::optional<std::size_t> open;     // offset of the innermost open bracket
    std::optional<std::size_t> suspect;  // offset of an opening bracket without a closing bracket of its
                                         // own, judged by the indentation
};

// The error in `text` at which the parser stopped. `place` formats an offset as "line:column".
SyntaxError explain_syntax(std::string_view text, const ParserStop& stop,
                           const std::function<std::string(std::size_t)>& place);

// The first byte that a content file must not contain: invalid UTF-8 or NUL.
std::optional<SyntaxError> explain_encoding(std::string_view text);

// Byte after the token that starts at `start`. The text must be valid JSON up to there.
std::size_t token_end(std::string_view text, std::size_t start);

// First byte at or after `from` that is not white space.
std::size_t skip_space(std::string_view text, std::size_t from);

// Length of the byte order mark at the start of the text: 3 or 0.
std::size_t byte_order_mark(std::string_view text);

}  // namespace bolt::content
