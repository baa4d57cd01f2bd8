#include "content/format/json_syntax.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>

#include "content/format/json_document.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::content {

namespace {

constexpr std::string_view number_rules =
    "as in 1.5, -2 or 3e-6: digits on both sides of the point, no leading zero or plus, no unit";

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_hex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

std::string shown(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) return fmt::format("'{}'", c);
    return fmt::format("byte 0x{:02X}", byte);
}

// The run of letters, digits and signs that starts at `p`: a number or literal, well-formed or not.
std::string_view word_at(std::string_view text, std::size_t p) {
    std::size_t end = p;
    while (end < text.size() &&
           (is_word(text[end]) || text[end] == '.' || text[end] == '-' || text[end] == '+'))
        ++end;
    return text.substr(p, end - p);
}

// Length of the JSON number at the start of `s`; 0 if there is none.
std::size_t number_length(std::string_view s) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t first = i;
        while (i < s.size() && is_digit(s[i])) ++i;
        return i - first;
    };
    if (i < s.size() && s[i] == '-') ++i;
    if (i < s.size() && s[i] == '0')
        ++i;  // a leading zero must not be followed by a digit
    else if (digits() == 0)
        return 0;
    std::size_t whole = i;
    if (i < s.size() && s[i] == '.') {
        ++i;
        if (digits() == 0) return whole;
        whole = i;
    }
    if (i < s.size() && (s[i] == 'e' || s[i] == 'E')) {
        ++i;
        if (i < s.size() && (s[i] == '-' || s[i] == '+')) ++i;
        if (digits() == 0) return whole;
        whole = i;
    }
    return whole;
}

using FormatPlace = std::function<std::string(std::size_t)>;

// The error inside the string that opens at `p`, if any.
std::optional<SyntaxError> string_mistake(std::string_view text, std::size_t p, const FormatPlace& place) {
    for (std::size_t i = p + 1; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if (text[i] == '"') return std::nullopt;
        if (text[i] == '\n' || text[i] == '\r')
            return SyntaxError{i,
                               fmt::format("the text that begins at {} is not closed on its line", place(p)),
                               "a '\"' at its end"};
        if (byte < 0x20)
            return SyntaxError{i, fmt::format("control character 0x{:02X} in a text", byte),
                               fmt::format("\\u{:04X}", byte)};
        if (text[i] != '\\') continue;
        const char escape = i + 1 < text.size() ? text[i + 1] : '\0';
        const auto hex4 = [&](std::size_t at) {
            if (at + 4 > text.size()) return false;
            for (std::size_t k = at; k < at + 4; ++k)
                if (!is_hex(text[k])) return false;
            return true;
        };
        if (escape == 'u') {
            if (!hex4(i + 2)) return SyntaxError{i, "\\u without four hexadecimal digits", "as in \\u00B5"};
            const unsigned unit =
                static_cast<unsigned>(std::stoul(std::string(text.substr(i + 2, 4)), nullptr, 16));
            const bool high = unit >= 0xD800 && unit < 0xDC00;
            const bool low_follows =
                text.substr(i + 6, 2) == "\\u" && hex4(i + 8) &&
                (std::stoul(std::string(text.substr(i + 8, 4)), nullptr, 16) & 0xFC00U) == 0xDC00U;
            if ((high && !low_follows) || (unit >= 0xDC00 && unit < 0xE000))
                return SyntaxError{i, "half of a surrogate pair", "both halves, or the character itself"};
            i += high ? 11 : 5;
        } else if (std::string_view("\"\\/bfnrt").find(escape) != std::string_view::npos && escape != '\0') {
            ++i;
        } else {
            return SyntaxError{i, "an invalid escape sequence",
                               "\\\\ for a backslash, or one of \\\" \\/ \\b \\f \\n \\r \\t \\uXXXX"};
        }
    }
    return SyntaxError{text.size(), fmt::format("the text that begins at {} is not closed", place(p)),
                       "a '\"' at its end"};
}

// The offset at which the string begins whose closing quote is the byte before `end`, if any.
std::optional<std::size_t> text_before(std::string_view text, std::size_t end) {
    if (end < 2 || text[end - 1] != '"') return std::nullopt;
    for (std::size_t i = end - 1; i > 0; --i) {
        if (text[i - 1] != '"') continue;
        std::size_t escapes = 0;
        while (escapes + 1 < i && text[i - 2 - escapes] == '\\') ++escapes;
        if (escapes % 2 == 0) return i - 1;
    }
    return std::nullopt;
}

// A number that continues after a valid JSON number: 013, 1.2.3, 5mm, 13,2.
std::optional<SyntaxError> number_mistake(std::string_view text, std::size_t end) {
    if (end == 0 || end >= text.size() || !is_digit(text[end - 1])) return std::nullopt;
    std::size_t start = end;
    while (start > 0 && (is_digit(text[start - 1]) ||
                         std::string_view("+-.eE").find(text[start - 1]) != std::string_view::npos))
        --start;
    if (text[end] == ',' && end + 1 < text.size() && is_digit(text[end + 1])) {
        const std::string_view rest = word_at(text, end + 1);
        return SyntaxError{
            start,
            fmt::format("{} with a comma", in_quotes(text.substr(start, end + 1 + rest.size() - start))),
            "a decimal point"};
    }
    const std::string_view word = word_at(text, start);
    if (start + word.size() <= end) return std::nullopt;
    return SyntaxError{start, fmt::format("{} is not a number as JSON writes it", in_quotes(word)),
                       std::string(number_rules)};
}

struct ExpectedToken {
    bool key = false, value = false;
    std::string words;  // description of the permitted tokens
};

ExpectedToken expected_after(ParserState last_token) {
    switch (last_token) {
        case ParserState::start:
            return {false, true, "'{'"};
        case ParserState::object_open:
            return {true, false, "a name in double quotes or '}'"};
        case ParserState::array_open:
            return {false, true, "a value or ']'"};
        case ParserState::key:
            return {false, false, "':' and a value"};
        case ParserState::object_value:
            return {false, false, "',' or '}'"};
        case ParserState::array_value:
            return {false, false, "',' or ']'"};
        case ParserState::end:
            return {false, false, "the end of the file"};
    }
    return {};
}

SyntaxError token_mistake(std::string_view text, std::size_t p, const ExpectedToken& expected_token,
                          const FormatPlace& place) {
    const char c = text[p];
    if (c == '/' || c == '#')
        return {p, "JSON has no comments", "no comment; in assembly.json \"sources\" can hold notes"};
    if (c == '\'') return {p, "single quotes", "double quotes (\")"};
    if (c == '"') {
        if (!expected_token.key && !expected_token.value)
            return {p, "something is missing before this text", expected_token.words};
        if (auto mistake = string_mistake(text, p, place)) return *mistake;
        return {p, "this text is not allowed here", expected_token.words};
    }
    const std::string_view word = word_at(text, p);
    if (word.empty()) return {p, fmt::format("{} is not allowed here", shown(c)), expected_token.words};
    if (expected_token.key)
        return {p, fmt::format("{} without quotes", in_quotes(word)), "a name in double quotes"};
    if (!expected_token.value) {
        // A word right after a closing quote: probably that quote was intended to open the next string.
        const auto opened_at = text_before(text, p);
        return {p, fmt::format("something is missing before {}", in_quotes(word)),
                opened_at ? fmt::format("{}, or a '\"' that closes the text that begins at {}",
                                        expected_token.words, place(*opened_at))
                          : expected_token.words};
    }
    if (number_length(word) == word.size())
        return {p, fmt::format("the number {} is too large", word.substr(0, 40)), "less than 1e308"};
    static const std::array<std::string, 3> literals = {"true", "false", "null"};
    const std::string best = nearest(word, literals);
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 && !best.empty())
        return {p, fmt::format("unknown word {}", in_quotes(word)), fmt::format("did you mean {}?", best)};
    if (is_digit(c) || c == '-' || c == '+' || c == '.')
        return {p, fmt::format("{} is not a number as JSON writes it", in_quotes(word)),
                std::string(number_rules)};
    return {p, fmt::format("unknown word {}", in_quotes(word)),
            "a number, a text in double quotes, true or false"};
}

}  // namespace

std::size_t byte_order_mark(std::string_view text) { return text.starts_with("\xEF\xBB\xBF") ? 3 : 0; }

std::size_t skip_space(std::string_view text, std::size_t from) {
    while (from < text.size() && std::string_view(" \t\r\n").find(text[from]) != std::string_view::npos)
        ++from;
    return from;
}

std::size_t token_end(std::string_view text, std::size_t start) {
    if (start >= text.size()) return text.size();
    if (text[start] == '"') {
        std::size_t i = start + 1;
        while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2U : 1U;
        return std::min(i + 1, text.size());
    }
    const std::string_view word = word_at(text, start);
    const std::size_t number = number_length(word);
    return start + std::max<std::size_t>(number > 0 ? number : word.size(), 1);
}

SyntaxError explain_syntax(std::string_view text, const ParserStop& stop, const FormatPlace& place) {
    const ParserState last_token = stop.last_token;
    ExpectedToken expected_token = expected_after(last_token);
    std::size_t p = skip_space(text, stop.end);
    // In a list, a comma between two numbers is probably a separator and not a decimal comma.
    if (last_token == ParserState::object_value ||
        (last_token == ParserState::array_value && p < text.size() && text[p] != ','))
        if (auto mistake = number_mistake(text, stop.end)) return *mistake;
    const auto unclosed = [&](SyntaxError mistake) {
        if (!stop.open) return mistake;
        mistake.what +=
            fmt::format(", and the '{}' opened at {} is not closed", text[*stop.open], place(*stop.open));
        if (stop.suspect)
            mistake.expected += fmt::format(
                "; by the indentation it is the '{}' opened at {} that lacks its '{}'", text[*stop.suspect],
                place(*stop.suspect), text[*stop.suspect] == '{' ? '}' : ']');
        return mistake;
    };
    const auto premature_end = [&] {
        std::size_t last = text.size();
        while (last > 0 && std::string_view(" \t\r\n").find(text[last - 1]) != std::string_view::npos) --last;
        if (last <= byte_order_mark(text))
            return SyntaxError{last, "the file is empty", expected_token.words};
        return unclosed({last, "the file ends too early", expected_token.words});
    };
    if (p >= text.size()) return premature_end();
    // Skip a valid separator; the error is after it.
    if (last_token == ParserState::key && text[p] == ':') {
        expected_token = {false, true, "a value"};
        p = skip_space(text, p + 1);
    } else if (text[p] == ',' &&
               (last_token == ParserState::object_value || last_token == ParserState::array_value)) {
        const std::size_t comma = p;
        const bool object = last_token == ParserState::object_value;
        expected_token = {object, !object, object ? "a name in double quotes" : "a value"};
        p = skip_space(text, p + 1);
        if (p < text.size() && text[p] == (object ? '}' : ']'))
            return {comma, fmt::format("nothing follows this comma but '{}'", text[p]),
                    "no comma here, or another value"};
    }
    if (p >= text.size()) return premature_end();
    SyntaxError mistake = token_mistake(text, p, expected_token, place);
    if (!stop.open || last_token == ParserState::key) return mistake;
    // A bracket of the other kind, a name in a list or an object in place of a name: the enclosing bracket
    // should have been closed before.
    const bool in_object = text[*stop.open] == '{';
    const bool is_misnested =
        in_object ? text[p] == ']' || (expected_token.key && (text[p] == '{' || text[p] == '['))
                  : text[p] == '}' || (text[p] == ':' && last_token == ParserState::array_value);
    return is_misnested ? unclosed(std::move(mistake)) : mistake;
}

std::optional<SyntaxError> explain_encoding(std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return SyntaxError{0, "the file is UTF-16", "UTF-8"};
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const auto bad = [&](std::size_t i) {
        return SyntaxError{i, fmt::format("byte 0x{:02X} is not UTF-8", byte(i)), "UTF-8"};
    };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = byte(i);
        if (lead == 0) return SyntaxError{i, "byte 0x00", "text"};
        if (lead < 0x80) {
            ++i;
            continue;
        }
        const std::size_t continuation_bytes = lead >= 0xC2 && lead < 0xE0   ? 1
                                               : lead >= 0xE0 && lead < 0xF0 ? 2
                                               : lead >= 0xF0 && lead < 0xF5 ? 3
                                                                             : 0;
        if (continuation_bytes == 0) return bad(i);
        for (std::size_t k = 1; k <= continuation_bytes; ++k)
            if ((byte(i + k) & 0xC0U) != 0x80U) return bad(i);
        const unsigned next = byte(i + 1);  // overlong forms, surrogates and values above U+10FFFF
        if ((lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) || (lead == 0xF0 && next < 0x90) ||
            (lead == 0xF4 && next > 0x8F))
            return bad(i);
        i += continuation_bytes + 1;
    }
    return std::nullopt;
}

}  // namespace bolt::content
