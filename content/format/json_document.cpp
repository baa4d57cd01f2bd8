#include "content/format/json_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "content/format/json_syntax.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::content {

std::string pointer_token(std::string_view key) {
    std::string token;
    for (const char c : key) {
        if (c == '~')
            token += "~0";
        else if (c == '/')
            token += "~1";
        else
            token += c;
    }
    return token;
}

std::vector<std::string> pointer_tokens(std::string_view pointer) {
    std::vector<std::string> tokens;
    for (std::size_t i = 0; i < pointer.size(); ++i) {
        if (pointer[i] == '/') {
            tokens.emplace_back();
        } else if (pointer[i] == '~' && i + 1 < pointer.size()) {
            tokens.back() += pointer[++i] == '1' ? '/' : '~';
        } else {
            tokens.back() += pointer[i];
        }
    }
    return tokens;
}

std::string last_token(std::string_view pointer) {
    const std::vector<std::string> tokens = pointer_tokens(pointer);
    return tokens.empty() ? std::string{} : tokens.back();
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t max_length = 60;
    std::string shown = "\"";
    std::size_t end = text.size();
    if (end > max_length) {
        end = max_length;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
            --end;  // do not cut inside a character
    }
    for (const char c : text.substr(0, end)) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte < 0x20 || byte == 0x7F ? '?' : c;
    }
    return shown + (end < text.size() ? "\"..." : "\"");
}

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    std::string best = nearest(name, known);
    if (best.empty()) return best;
    const std::size_t distance = edit_distance(name, best);
    if (distance >= name.size()) return {};  // no letter in common
    const bool is_unique = std::none_of(known.begin(), known.end(), [&](const std::string& other) {
        return other != best && edit_distance(name, other) <= distance;
    });
    return is_unique ? best : std::string{};
}

std::string suggest(std::string_view name, std::span<const std::string> known) {
    const std::string best = nearest_name(name, known);
    if (!best.empty()) return fmt::format("did you mean {}?", in_quotes(best));
    constexpr std::size_t max_names = 20;  // a longer list does not help
    if (known.size() > max_names)
        return fmt::format("one of {}, ...", fmt::join(known.subspan(0, max_names), ", "));
    if (known.size() == 1) return fmt::format("{}", in_quotes(known.front()));
    return fmt::format("one of {}", fmt::join(known, ", "));
}

using nlohmann::json;

namespace {
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t json_repeat_limit = 100;  // repeated names before parsing stops
}  // namespace

// One value of the text, linked to its first child and its next sibling in the order of the file. A table of
// JSON pointers would be simpler, but its size would grow with the depth times the length of the keys.
struct JsonDocument::Entry {
    std::uint32_t key_offset = 0;
    std::uint32_t value_offset = 0;
    std::uint32_t first_child = none;
    std::uint32_t next_sibling = none;
    std::string key;  // of the member, if the parent is an object
};

struct JsonDocument::Content {
    json root;
    std::string file;
    std::vector<Entry> entries;
    std::vector<std::size_t> line_starts{0};
    std::vector<std::uint32_t> inner_bytes;  // sorted offsets of UTF-8 continuation bytes
};

// SAX handler that builds the values and their positions. nlohmann's parser does not report where a token
// starts. A token starts at the first byte after the previous one that is not white space, comma or colon.
class JsonBuilder {
  public:
    JsonBuilder(std::string_view text, JsonDocument& document, std::vector<Error>& errors)
        : text_(text), document_(document), errors_(errors), end_(byte_order_mark(text)) {}

    bool null() { return add(json(nullptr)); }
    bool boolean(bool value) { return add(json(value)); }
    bool number_integer(json::number_integer_t value) { return add(number(value)); }
    bool number_unsigned(json::number_unsigned_t value) { return add(number(value)); }
    bool number_float(json::number_float_t value, const std::string&) { return add(json(value)); }
    bool string(std::string& value) { return add(json(std::move(value))); }
    bool binary(json::binary_t&) { return false; }
    bool start_object(std::size_t) { return open(json::object()); }
    bool start_array(std::size_t) { return open(json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& value) {
        key_offset_ = next_token();
        last_token_ = ParserState::key;
        if (value.empty()) return stop_at(key_offset_, "an empty name", "a name of at least one letter");
        if (value.size() > json_key_limit)
            return stop_at(key_offset_, "a name of more than 128 bytes", "a shorter name");
        if (std::any_of(value.begin(), value.end(),
                        [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
            return stop_at(key_offset_, "a name with a control character in it", "plain text");
        OpenBracket& object = stack_.back();
        if (object.value->contains(value)) {
            // Position of the first occurrence, whose value counts.
            std::uint32_t first = document_.content_->entries[object.entry].first_child;
            while (document_.content_->entries[first].key != value)
                first = document_.content_->entries[first].next_sibling;
            const Error place = document_.error_at(document_.content_->entries[first].key_offset, {}, {});
            Error error = document_.error_at(key_offset_, fmt::format("{} is given twice", in_quotes(value)),
                                             fmt::format("one value; the first is in line {}", place.line));
            error.pointer = pointer_of(value);
            errors_.push_back(std::move(error));
            if (errors_.size() > json_repeat_limit) return false;
            slot_ = &discarded_.emplace_back();
        } else {
            slot_ = &(*object.value)[value];
        }
        key_ = std::move(value);
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const json::exception&) {
        ParserStop where{end_, last_token_, {}, misclosed_};
        if (!stack_.empty()) where.open = document_.content_->entries[stack_.back().entry].value_offset;
        const SyntaxError mistake =
            explain_syntax(text_, where, [&](std::size_t offset) { return document_.place(offset); });
        return stop_at(mistake.offset, mistake.what, mistake.expected);
    }

  private:
    struct OpenBracket {
        json* value;
        std::uint32_t entry;
        std::uint32_t last_child;
        std::string key;
        std::size_t indent;  // of the line with the opening bracket
    };

    // Integers beyond the exact range of double are stored as doubles; content files need none.
    template <class Integer>
    static json number(Integer value) {
        constexpr double exact = 9007199254740992.0;  // 2⁵³
        const auto real = static_cast<double>(value);
        return real > exact || real < -exact ? json(real) : json(static_cast<std::int64_t>(value));
    }

    std::size_t next_token() {
        std::size_t start = skip_space(text_, end_);
        while (start < text_.size() && (text_[start] == ',' || text_[start] == ':'))
            start = skip_space(text_, start + 1);
        const std::size_t line = document_.line_start(start);
        first_on_line_ = line >= end_;
        if (first_on_line_) indent_ = start - std::min(line, start);
        end_ = token_end(text_, start);
        return start;
    }

    bool stop_at(std::size_t offset, std::string what, std::string expected) {
        errors_.push_back(document_.error_at(offset, std::move(what), std::move(expected)));
        return false;
    }

    [[nodiscard]] std::string pointer_of(std::string_view last) const {
        std::string pointer;
        for (std::size_t i = 1; i < stack_.size(); ++i) pointer += "/" + pointer_token(stack_[i].key);
        return pointer + "/" + pointer_token(last);
    }

    void value_read() {
        if (stack_.empty())
            last_token_ = ParserState::end;
        else
            last_token_ =
                stack_.back().value->is_object() ? ParserState::object_value : ParserState::array_value;
    }

    json* store(json value) {
        const std::size_t offset = next_token();
        auto& entries = document_.content_->entries;
        if (entries.size() >= json_value_limit) {
            stop_at(offset, fmt::format("the file holds more than {} values", json_value_limit), {});
            return nullptr;
        }
        const auto index = static_cast<std::uint32_t>(entries.size());
        JsonDocument::Entry entry;
        entry.value_offset = entry.key_offset = static_cast<std::uint32_t>(offset);
        json* slot = &document_.content_->root;
        if (!stack_.empty()) {
            OpenBracket& parent = stack_.back();
            if (parent.value->is_object()) {
                entry.key_offset = static_cast<std::uint32_t>(key_offset_);
                entry.key = key_;
                slot = slot_;
            } else {
                key_ = std::to_string(parent.value->size());
                parent.value->push_back(json());
                slot = &parent.value->back();
            }
            (parent.last_child == none ? entries[parent.entry].first_child
                                       : entries[parent.last_child].next_sibling) = index;
            parent.last_child = index;
        }
        entries.push_back(std::move(entry));
        *slot = std::move(value);
        return slot;
    }

    bool add(json value) {
        if (store(std::move(value)) == nullptr) return false;
        value_read();
        return true;
    }

    bool open(json value) {
        const bool object = value.is_object();
        json* slot = store(std::move(value));
        if (slot == nullptr) return false;
        const auto index = static_cast<std::uint32_t>(document_.content_->entries.size() - 1);
        if (stack_.size() >= json_depth_limit)
            return stop_at(document_.content_->entries[index].value_offset,
                           fmt::format("nested more than {} levels deep", json_depth_limit), {});
        stack_.push_back({slot, index, none, key_, indent_});
        last_token_ = object ? ParserState::object_open : ParserState::array_open;
        return true;
    }

    bool close() {
        next_token();
        // A closing bracket with less indentation than the line that opened it probably belongs to an outer
        // bracket.
        const OpenBracket& top = stack_.back();
        if (!misclosed_ && first_on_line_ && indent_ < top.indent)
            misclosed_ = document_.content_->entries[top.entry].value_offset;
        stack_.pop_back();
        value_read();
        return true;
    }

    std::string_view text_;
    JsonDocument& document_;
    std::vector<Error>& errors_;
    std::size_t end_;  // byte after the last token read
    ParserState last_token_ = ParserState::start;
    std::vector<OpenBracket> stack_;
    bool first_on_line_ = false;  // of the last token
    std::size_t indent_ = 0;      // of the last token's line
    // First bracket that was probably closed by another's closing bracket.
    std::optional<std::size_t> misclosed_;
    std::size_t key_offset_ = 0;
    std::string key_;
    json* slot_ = nullptr;  // destination of the value of the current key
    // Values of repeated keys; a deque keeps their addresses stable while they are filled.
    std::deque<json> discarded_;
};

void sort_by_position(std::vector<Error>& errors) {
    std::stable_sort(errors.begin(), errors.end(), [](const Error& a, const Error& b) {
        return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    });
}

JsonDocument::JsonDocument(std::string_view text, std::string_view file)
    : content_(std::make_unique<Content>()) {
    content_->file = file;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\n') content_->line_starts.push_back(i + 1);
        if ((static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U)
            content_->inner_bytes.push_back(static_cast<std::uint32_t>(i));
    }
    content_->line_starts[0] = byte_order_mark(text);  // editors do not display it
}

JsonDocument::~JsonDocument() = default;

std::unique_ptr<JsonDocument> JsonDocument::parse(std::string_view text, std::string_view file,
                                                  std::vector<Error>& errors) {
    std::unique_ptr<JsonDocument> document(new JsonDocument(text.substr(0, json_size_limit), file));
    if (text.size() > json_size_limit) {
        errors.push_back(document->error_at(0, "the file is larger than 4 MiB", {}));
        return nullptr;
    }
    if (const auto mistake = explain_encoding(text)) {
        errors.push_back(document->error_at(mistake->offset, mistake->what, mistake->expected));
        return nullptr;
    }
    JsonBuilder builder(text, *document, errors);
    if (!json::sax_parse(text.begin(), text.end(), &builder)) return nullptr;
    return document;
}

const json& JsonDocument::root() const { return content_->root; }

std::size_t JsonDocument::offset(std::string_view pointer, JsonPart part) const {
    const auto& entries = content_->entries;
    if (entries.empty()) return 0;
    std::uint32_t at = 0;
    const std::vector<std::string> tokens = pointer_tokens(pointer);
    std::size_t found = 0;
    for (const std::string& token : tokens) {
        std::uint32_t child = entries[at].first_child;
        std::size_t index = 0;
        const auto matches = [&](const Entry& e) {
            return e.key.empty() ? token == std::to_string(index) : token == e.key;
        };
        while (child != none && !matches(entries[child])) {
            child = entries[child].next_sibling;
            ++index;
        }
        if (child == none) break;
        at = child;
        ++found;
    }
    return part == JsonPart::key && found == tokens.size() ? entries[at].key_offset
                                                           : entries[at].value_offset;
}

std::size_t JsonDocument::line_start(std::size_t offset) const {
    const auto& starts = content_->line_starts;
    const auto next = std::upper_bound(starts.begin(), starts.end(), offset);
    return next == starts.begin() ? *next : *(next - 1);
}

Error JsonDocument::error_at(std::size_t offset, std::string what, std::string expected) const {
    const auto& starts = content_->line_starts;
    const std::size_t line = line_start(offset), from = std::min(line, offset);
    const auto inner_before = [&](std::size_t at) {
        const auto& inner = content_->inner_bytes;
        return std::lower_bound(inner.begin(), inner.end(), at) - inner.begin();
    };
    Error error;
    error.code = ErrorCode::bad_content;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.file = content_->file;
    error.line = static_cast<int>(std::lower_bound(starts.begin(), starts.end(), line) - starts.begin()) + 1;
    error.column =
        static_cast<int>(offset - from) - static_cast<int>(inner_before(offset) - inner_before(from)) + 1;
    return error;
}

std::string JsonDocument::place(std::size_t offset) const {
    const Error error = error_at(offset, {}, {});
    return fmt::format("{}:{}", error.line, error.column);
}

Error JsonDocument::error(std::string_view pointer, JsonPart part, std::string what,
                          std::string expected) const {
    Error error = error_at(offset(pointer, part), std::move(what), std::move(expected));
    error.pointer = pointer;
    return error;
}

int JsonDocument::line(std::string_view pointer, JsonPart part) const {
    return error_at(offset(pointer, part), {}, {}).line;
}

}  // namespace bolt::content
