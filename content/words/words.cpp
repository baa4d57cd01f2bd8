#include "content/words/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/folders.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/file.hpp"

namespace bolt::words {

namespace {

using content::in_quotes;
using content::JsonDocument;
using content::JsonPart;
using content::pointer_token;
using nlohmann::json;

constexpr const char* format_name = "boltwright words 1";
constexpr std::size_t max_file_size = 1U << 20U;
constexpr std::size_t max_text_size = 1000;  // bytes

constexpr bool unique_keys() {
    for (std::size_t i = 0; i < key_count; ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (key_rows[i].name == key_rows[k].name) return false;
    return true;
}
static_assert(unique_keys());

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> list;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(separator), text.size());
        list.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return list;
}

// The text between the braces of a placeholder: a name, or "fastener: nut|screw".
struct Placeholder {
    std::string_view name;
    std::vector<std::string> texts;  // of a choice

    explicit Placeholder(std::string_view inside) : name(inside.substr(0, inside.find(':'))) {
        inside.remove_prefix(std::min(name.size() + 1, inside.size()));
        if (inside.starts_with(' ')) inside.remove_prefix(1);
        texts = split(inside, '|');
    }
};

const ChoiceRow* choice_named(std::string_view name) {
    const auto* const row = std::find_if(std::begin(choice_rows), std::end(choice_rows),
                                         [&](const ChoiceRow& choice) { return choice.name == name; });
    return row == std::end(choice_rows) ? nullptr : row;
}

struct WordsChecker {
    const JsonDocument& document;
    std::vector<Error>& errors;

    void report(const std::string& pointer, JsonPart part, std::string what, std::string expected) {
        errors.push_back(document.error(pointer, part, std::move(what), std::move(expected)));
    }

    std::string text(const json& object, const std::string& at, const std::string& key) {
        const auto it = object.find(key);
        if (it == object.end()) {
            report(at, JsonPart::value, fmt::format("{} is missing", in_quotes(key)), {});
            return {};
        }
        if (it->is_string()) {
            const auto& value = it->get_ref<const std::string&>();
            if (!value.empty() && value.size() <= max_text_size) return value;
        }
        report(at + "/" + pointer_token(key), JsonPart::value,
               fmt::format("{} is empty or not a text", in_quotes(key)),
               fmt::format("a text of at most {} bytes", max_text_size));
        return {};
    }

    void check_known(const json& object, const std::string& at, const std::vector<std::string>& known) {
        for (const auto& [key, value] : object.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                report(at + "/" + pointer_token(key), JsonPart::key,
                       fmt::format("{} is not known here", in_quotes(key)), content::suggest(key, known));
    }

    // Checks that a choice has as many texts as it needs, and that no other placeholder has any.
    void check_choice(const std::string& pointer, const Placeholder& placeholder) {
        const ChoiceRow* choice = choice_named(placeholder.name);
        const std::size_t texts = choice == nullptr ? 0 : choice->texts;
        if (placeholder.texts.size() == texts) return;
        report(pointer, JsonPart::value,
               fmt::format("{{{}}} has {} texts to choose from", placeholder.name, placeholder.texts.size()),
               choice == nullptr ? "none" : fmt::format("{}, as in {}", texts, choice->example));
    }

    // Checks that a text has exactly the placeholders of its key; it may leave out choices.
    void check_placeholders(const std::string& pointer, const std::string& text,
                            const std::vector<std::string>& expected_names) {
        std::set<std::string> found;
        std::size_t at = 0;
        while ((at = text.find_first_of("{}", at)) != std::string::npos) {
            const std::size_t end = text.find_first_of("{}", at + 1);
            if (text[at] == '}' || end == std::string::npos || text[end] == '{') {
                report(pointer, JsonPart::value, "a brace is unmatched", "placeholders of the form {name}");
                return;
            }
            const Placeholder placeholder(std::string_view(text).substr(at + 1, end - at - 1));
            found.emplace(placeholder.name);
            check_choice(pointer, placeholder);
            at = end + 1;
        }
        for (const std::string& name : found)
            if (std::find(expected_names.begin(), expected_names.end(), name) == expected_names.end())
                report(pointer, JsonPart::value, fmt::format("unknown placeholder {{{}}}", name),
                       expected_names.empty() ? "a text without placeholders"
                                              : content::suggest(name, expected_names));
        for (const std::string& name : expected_names)
            if (!found.contains(name) && choice_named(name) == nullptr)
                report(pointer, JsonPart::value, fmt::format("{{{}}} is missing in the text", name), {});
    }

    void read_header(const json& root, Words& words) {
        if (const std::string format = text(root, "", "format"); !format.empty() && format != format_name)
            report("/format", JsonPart::value, "the format of the words file is unknown",
                   fmt::format("\"format\": \"{}\"", format_name));
        check_known(root, "", {"format", "language", "name", "decimal", "words"});
        words.language = text(root, "", "language");
        words.name = text(root, "", "name");
        words.decimal = text(root, "", "decimal");
        if (!words.decimal.empty() && words.decimal != "." && words.decimal != ",")
            report("/decimal", JsonPart::value,
                   fmt::format("{} is not a decimal sign", in_quotes(words.decimal)), R"("." or ",")");
    }

    void read_texts(const json& all, LoadedWords& loaded) {
        Words& words = loaded.words;
        std::vector<std::string> known;
        for (const KeyRow& row : key_rows) known.emplace_back(row.name);
        check_known(all, "/words", known);
        for (std::size_t i = 0; i < key_count; ++i) {
            words.texts[i] = text(all, "/words", known[i]);
            const std::string pointer = "/words/" + pointer_token(known[i]);
            loaded.lines[i] = document.line(pointer);
            if (!words.texts[i].empty())
                check_placeholders(pointer, words.texts[i], split(key_rows[i].placeholders, ' '));
        }
    }
};

Error unknown_language(std::string_view language, const std::vector<std::string>& available) {
    Error error;
    error.code = ErrorCode::usage;
    error.what = fmt::format("there is no words file for the language {}", in_quotes(language));
    error.expected =
        available.empty() ? "a language file in content/words" : content::suggest(language, available);
    return error;
}

}  // namespace

std::string format_number(const Words& words, const Number& number) {
    std::string text = fmt::format("{:.{}f}", number.value, number.decimals);
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    if (zero && text.front() == '-') text.erase(0, 1);
    if (const std::size_t point = text.find('.'); point != std::string::npos)
        text.replace(point, 1, words.decimal);
    return text;
}

std::string replace_placeholders(const Words& words, std::string_view text,
                                 std::span<const TextArgument> arguments) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t open = std::min(text.find('{', at), text.size());
        result.append(text, at, open - at);
        if (open == text.size()) break;
        const std::size_t close = text.find('}', open);
        const Placeholder placeholder(text.substr(open + 1, close - open - 1));
        const auto argument =
            std::find_if(arguments.begin(), arguments.end(),
                         [&](const TextArgument& candidate) { return candidate.name == placeholder.name; });
        if (argument == arguments.end())
            result.append(text, open, close + 1 - open);
        else if (const auto* choice = std::get_if<Choice>(&argument->value))
            result += placeholder.texts.at(choice->index);
        else if (const auto* number = std::get_if<Number>(&argument->value))
            result += format_number(words, *number);
        else
            result += std::get<std::string>(argument->value);
        at = close + 1;
    }
    return result;
}

std::string format_text(const Words& words, TextKey key, std::span<const TextArgument> arguments) {
    return replace_placeholders(words, words[key], arguments);
}

std::string format_text(const Words& words, TextKey key, std::initializer_list<TextArgument> arguments) {
    return format_text(words, key, std::span(arguments.begin(), arguments.size()));
}

Number torque_number(double newton_metres) {
    const bool whole = std::abs(newton_metres - std::round(newton_metres)) < 0.05;
    return {newton_metres, whole || std::abs(newton_metres) >= 100.0 ? 0 : 1};
}

LoadedWords parse_words(std::string_view text, std::string_view file) {
    LoadedWords loaded;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    WordsChecker checker{*document, loaded.errors};
    const json& root = document->root();
    if (!root.is_object()) {
        checker.report("", JsonPart::value, "the words file is not an object", "a JSON object");
        return loaded;
    }
    checker.read_header(root, loaded.words);
    if (const auto all = root.find("words"); all == root.end())
        checker.report("", JsonPart::value, "\"words\" is missing", {});
    else if (!all->is_object())
        checker.report("/words", JsonPart::value, "\"words\" is not an object", "an object of texts by key");
    else
        checker.read_texts(*all, loaded);
    content::sort_by_position(loaded.errors);
    return loaded;
}

LoadedWords load_words(const std::filesystem::path& folder, std::string_view language) {
    LoadedWords loaded;
    const std::vector<std::string> available = languages(folder);
    if (std::find(available.begin(), available.end(), language) == available.end()) {
        loaded.errors.push_back(unknown_language(language, available));
        return loaded;
    }
    return read_words(folder / fmt::format("{}.json", language));
}

LoadedWords read_words(const std::filesystem::path& file) {
    LoadedWords loaded;
    const Result<std::string> text = read_file(file, max_file_size, ErrorCode::bad_content);
    if (!text) {
        loaded.errors.push_back(text.error());
        return loaded;
    }
    loaded = parse_words(*text, file.string());
    const std::string language = file.stem().string();
    if (loaded.ok() && loaded.words.language != language) {
        Error error;
        error.code = ErrorCode::bad_content;
        error.file = file.string();
        error.pointer = "/language";
        error.what = fmt::format("the language is {}", in_quotes(loaded.words.language));
        error.expected = fmt::format("the language of the file name, {}", in_quotes(language));
        loaded.errors.push_back(std::move(error));
    }
    return loaded;
}

std::vector<std::string> languages(const std::filesystem::path& folder) {
    std::vector<std::string> codes;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".json") codes.push_back(entry.path().stem().string());
    std::sort(codes.begin(), codes.end());
    return codes;
}

std::filesystem::path words_folder() { return content::content_folder() / "words"; }

std::string language_of_desktop(std::span<const std::string> available) {
    for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
        const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
        if (value == nullptr || *value == 0) continue;
        const std::string code = std::string(value).substr(0, 2);
        if (std::find(available.begin(), available.end(), code) != available.end()) return code;
        break;
    }
    return "en";
}

}  // namespace bolt::words
