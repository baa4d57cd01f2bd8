// Reads small JSON files, member by member.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "content/format/json_document.hpp"

namespace bolt::content {

// Reads the members of objects. `at` is the JSON pointer of the object. A member that is missing or invalid
// is an error; text() then returns an empty text, number() returns `low`, and flag() false. The first error
// is kept with its position; later ones are ignored.
struct MemberReader {
    using json = nlohmann::json;
    static constexpr std::size_t max_text = 200;  // bytes

    const JsonDocument& document;
    std::optional<Error> first_error;

    void report(const std::string& pointer, JsonPart part, std::string what, std::string expected) {
        if (!first_error) first_error = document.error(pointer, part, std::move(what), std::move(expected));
    }
    // Returns null and reports an error if the member is missing.
    const json* find(const json& object, const std::string& at, const char* key) {
        const auto it = object.find(key);
        if (it != object.end()) return &*it;
        report(at, JsonPart::value, fmt::format("\"{}\" is missing", key), {});
        return nullptr;
    }
    std::string text(const json& object, const std::string& at, const char* key,
                     std::size_t longest = max_text) {
        const json* value = find(object, at, key);
        if (value == nullptr) return {};
        if (value->is_string() && value->get_ref<const std::string&>().size() <= longest)
            return value->get<std::string>();
        report(at + "/" + key, JsonPart::value, fmt::format("\"{}\" is not a short text", key),
               fmt::format("a text of at most {} bytes", longest));
        return {};
    }
    double number(const json& object, const std::string& at, const char* key, double low, double high) {
        const json* value = find(object, at, key);
        if (value == nullptr) return low;
        const double x = value->is_number() ? value->get<double>() : std::nan("");
        if (x >= low && x <= high) return x;
        report(at + "/" + key, JsonPart::value,
               fmt::format("\"{}\" cannot be {}", key, in_quotes(value->dump())),
               fmt::format("a number from {} to {}", low, high));
        return low;
    }
    bool flag(const json& object, const std::string& at, const char* key) {
        const json* value = find(object, at, key);
        if (value == nullptr) return false;
        if (value->is_boolean()) return value->get<bool>();
        report(at + "/" + key, JsonPart::value,
               fmt::format("\"{}\" cannot be {}", key, in_quotes(value->dump())), "true or false");
        return false;
    }
    void check_known(const json& object, const std::string& at, const std::vector<std::string>& known) {
        for (const auto& [key, value] : object.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                report(at + "/" + pointer_token(key), JsonPart::key,
                       fmt::format("{} is not known here", in_quotes(key)), suggest(key, known));
    }
};

// The beginning of a small file.
struct FileHead {
    const char* name;                  // for messages: "station file"
    const char* format;                // the value of its member "format"
    std::vector<std::string> members;  // the other members of its object
};

// Parses a file that `head` describes and returns the value of `read(members, root)`, or the first error of
// the file.
template <class Read>
auto parse_small_file(std::string_view text, const std::string& file, FileHead head, const Read& read)
    -> Result<decltype(read(std::declval<MemberReader&>(), std::declval<const nlohmann::json&>()))> {
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, file, errors);
    if (!errors.empty()) return fail(errors.front());
    MemberReader members{*document, {}};
    const nlohmann::json& root = document->root();
    if (!root.is_object()) {
        members.report("", JsonPart::value, fmt::format("the {} is not an object", head.name),
                       "a JSON object");
        return fail(*members.first_error);
    }
    if (members.text(root, "", "format") != head.format)
        members.report("/format", JsonPart::value, fmt::format("the format of the {} is unknown", head.name),
                       fmt::format("\"format\": \"{}\"", head.format));
    head.members.emplace_back("format");
    members.check_known(root, "", head.members);
    auto value = read(members, root);
    if (members.first_error) return fail(*members.first_error);
    return value;
}

}  // namespace bolt::content
