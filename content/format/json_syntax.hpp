// Says in plain words why a text is no JSON.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace bolt::content {

struct SyntaxMistake {
    std::size_t offset = 0;  // byte where it stands
    std::string what;
    std::string expected;
};

// What the parser had read when it stopped.
enum class Before { start, object_open, array_open, key, object_value, array_value, end };

struct Stopped {
    std::size_t end = 0;  // byte behind the last good token
    Before before = Before::start;
    std::optional<std::size_t> open;     // the innermost bracket that is open
    std::optional<std::size_t> suspect;  // an earlier one that another's closing bracket seems to have closed
};

// The mistake in `text` where the parser stopped. `place` writes an offset as "line:column".
SyntaxMistake explain_syntax(std::string_view text, const Stopped& where,
                             const std::function<std::string(std::size_t)>& place);

// The first byte that no content file may hold: not UTF-8, or NUL.
std::optional<SyntaxMistake> explain_encoding(std::string_view text);

// Byte behind the token that starts at `start` of a text that is known to be JSON up to there.
std::size_t token_end(std::string_view text, std::size_t start);

// First byte at or behind `from` that is not white space.
std::size_t skip_space(std::string_view text, std::size_t from);

// Bytes of the byte order mark that the text starts with: 3 or 0.
std::size_t byte_order_mark(std::string_view text);

}  // namespace bolt::content
