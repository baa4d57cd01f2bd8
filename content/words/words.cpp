#include "content/words/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/assembly.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/file.hpp"

namespace bolt::words {

namespace {

using content::in_quotes;
using content::JsonDocument;
using content::Part;
using content::pointer_token;
using nlohmann::json;

constexpr const char* format_name = "boltwright words 1";
constexpr std::size_t longest_file = 1U << 20U;
constexpr std::size_t longest_text = 1000;  // bytes

constexpr bool unique_keys() {
    for (std::size_t i = 0; i < key_count; ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (key_rows[i].name == key_rows[k].name) return false;
    return true;
}
static_assert(unique_keys());

std::vector<std::string> split(std::string_view names) {
    std::vector<std::string> list;
    while (!names.empty()) {
        const std::size_t end = std::min(names.find(' '), names.size());
        list.emplace_back(names.substr(0, end));
        names.remove_prefix(std::min(end + 1, names.size()));
    }
    return list;
}

struct Checker {
    const JsonDocument& document;
    std::vector<Error>& errors;

    void report(const std::string& pointer, Part part, std::string what, std::string expected) {
        errors.push_back(document.error(pointer, part, std::move(what), std::move(expected)));
    }

    std::string text(const json& object, const std::string& at, const std::string& key) {
        const auto it = object.find(key);
        if (it == object.end()) {
            report(at, Part::value, fmt::format("{} is missing", in_quotes(key)), {});
            return {};
        }
        if (it->is_string()) {
            const auto& value = it->get_ref<const std::string&>();
            if (!value.empty() && value.size() <= longest_text) return value;
        }
        report(at + "/" + pointer_token(key), Part::value, fmt::format("{} says nothing", in_quotes(key)),
               fmt::format("expected a text of at most {} bytes", longest_text));
        return {};
    }

    void only(const json& object, const std::string& at, const std::vector<std::string>& known) {
        for (const auto& [key, value] : object.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                report(at + "/" + pointer_token(key), Part::key,
                       fmt::format("{} is not known here", in_quotes(key)), content::suggest(key, known));
    }

    // The places of a text are those of its key, no more and no less.
    void places(const std::string& pointer, const std::string& text, const std::vector<std::string>& wanted) {
        std::set<std::string> named;
        std::size_t at = 0;
        while ((at = text.find_first_of("{}", at)) != std::string::npos) {
            const std::size_t end = text.find_first_of("{}", at + 1);
            if (text[at] == '}' || end == std::string::npos || text[end] == '{') {
                report(pointer, Part::value, "a brace stands alone", "expected places as {name}");
                return;
            }
            named.insert(text.substr(at + 1, end - at - 1));
            at = end + 1;
        }
        for (const std::string& name : named)
            if (std::find(wanted.begin(), wanted.end(), name) == wanted.end())
                report(pointer, Part::value, fmt::format("nothing is put into {{{}}} here", name),
                       wanted.empty() ? "expected a text without places" : content::suggest(name, wanted));
        for (const std::string& name : wanted)
            if (!named.contains(name))
                report(pointer, Part::value, fmt::format("{{{}}} is missing in the text", name), {});
    }

    void head(const json& root, Words& words) {
        if (const std::string format = text(root, "", "format"); !format.empty() && format != format_name)
            report("/format", Part::value, "these are no words that are known here",
                   fmt::format("expected \"format\": \"{}\"", format_name));
        only(root, "", {"format", "language", "name", "decimal", "words"});
        words.language = text(root, "", "language");
        words.name = text(root, "", "name");
        words.decimal = text(root, "", "decimal");
        if (!words.decimal.empty() && words.decimal != "." && words.decimal != ",")
            report("/decimal", Part::value, fmt::format("{} is no decimal sign", in_quotes(words.decimal)),
                   R"(expected "." or ",")");
    }

    void texts(const json& all, Loaded& loaded) {
        Words& words = loaded.words;
        std::vector<std::string> known;
        for (const KeyRow& row : key_rows) known.emplace_back(row.name);
        only(all, "/words", known);
        for (std::size_t i = 0; i < key_count; ++i) {
            words.texts[i] = text(all, "/words", known[i]);
            const std::string pointer = "/words/" + pointer_token(known[i]);
            loaded.lines[i] = document.line(pointer);
            if (!words.texts[i].empty()) places(pointer, words.texts[i], split(key_rows[i].places));
        }
    }
};

Error unknown_language(std::string_view language, const std::vector<std::string>& there) {
    Error error;
    error.code = ErrorCode::usage;
    error.what = fmt::format("there are no words in the language {}", in_quotes(language));
    error.expected = there.empty() ? "content/words holds no language" : content::suggest(language, there);
    return error;
}

}  // namespace

std::string say(const Words& words, const Number& number) {
    std::string text = fmt::format("{:.{}f}", number.value, number.decimals);
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    if (zero && text.front() == '-') text.erase(0, 1);
    if (const std::size_t point = text.find('.'); point != std::string::npos)
        text.replace(point, 1, words.decimal);
    return text;
}

std::string say(const Words& words, Key key, std::span<const Place> places) {
    const std::string& text = words[key];
    std::string said;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t open = std::min(text.find('{', at), text.size());
        said.append(text, at, open - at);
        if (open == text.size()) break;
        const std::size_t close = text.find('}', open);
        const std::string_view name = std::string_view(text).substr(open + 1, close - open - 1);
        const auto place = std::find_if(places.begin(), places.end(),
                                        [&](const Place& candidate) { return candidate.name == name; });
        if (place == places.end())
            said.append(text, open, close + 1 - open);
        else if (const auto* number = std::get_if<Number>(&place->value))
            said += say(words, *number);
        else
            said += std::get<std::string>(place->value);
        at = close + 1;
    }
    return said;
}

std::string say(const Words& words, Key key, std::initializer_list<Place> places) {
    return say(words, key, std::span(places.begin(), places.size()));
}

Number torque_number(double newton_metres) {
    const bool whole = std::abs(newton_metres - std::round(newton_metres)) < 0.05;
    return {newton_metres, whole || std::abs(newton_metres) >= 100.0 ? 0 : 1};
}

Loaded parse_words(std::string_view text, std::string_view file) {
    Loaded loaded;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    Checker checker{*document, loaded.errors};
    const json& root = document->root();
    if (!root.is_object()) {
        checker.report("", Part::value, "these are no words", "expected a JSON object");
        return loaded;
    }
    checker.head(root, loaded.words);
    if (const auto all = root.find("words"); all == root.end())
        checker.report("", Part::value, "\"words\" is missing", {});
    else if (!all->is_object())
        checker.report("/words", Part::value, "these are no words", "expected an object of texts by key");
    else
        checker.texts(*all, loaded);
    std::stable_sort(loaded.errors.begin(), loaded.errors.end(), [](const Error& a, const Error& b) {
        return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    });
    return loaded;
}

Loaded load_words(const std::filesystem::path& folder, std::string_view language) {
    Loaded loaded;
    const std::vector<std::string> there = languages(folder);
    if (std::find(there.begin(), there.end(), language) == there.end()) {
        loaded.errors.push_back(unknown_language(language, there));
        return loaded;
    }
    return read_words(folder / fmt::format("{}.json", language));
}

Loaded read_words(const std::filesystem::path& file) {
    Loaded loaded;
    const Result<std::string> text = read_file(file, longest_file, ErrorCode::bad_content);
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
        error.expected = fmt::format("expected that of the file's name, {}", in_quotes(language));
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

std::string language_of_desktop(std::span<const std::string> there) {
    for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
        const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
        if (value == nullptr || *value == 0) continue;
        const std::string code = std::string(value).substr(0, 2);
        if (std::find(there.begin(), there.end(), code) != there.end()) return code;
        break;
    }
    return "en";
}

}  // namespace bolt::words
