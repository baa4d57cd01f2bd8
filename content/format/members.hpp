// Reads the members of objects in a small file that has no schema: the first mistake is kept, with its place,
// and all that follows is of no account.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "content/format/json_document.hpp"

namespace bolt::content {

struct Members {
    using json = nlohmann::json;
    static constexpr std::size_t longest_text = 200;  // bytes

    const JsonDocument& document;
    std::optional<Error> wrong;

    void report(const std::string& pointer, Part part, std::string what, std::string expected) {
        if (!wrong) wrong = document.error(pointer, part, std::move(what), std::move(expected));
    }
    // Null, and a mistake, where it is missing.
    const json* find(const json& object, const std::string& at, const char* key) {
        const auto it = object.find(key);
        if (it != object.end()) return &*it;
        report(at, Part::value, fmt::format("\"{}\" is missing", key), {});
        return nullptr;
    }
    std::string text(const json& object, const char* key, std::size_t longest = longest_text) {
        const json* value = find(object, "", key);
        if (value == nullptr) return {};
        if (value->is_string() && value->get_ref<const std::string&>().size() <= longest)
            return value->get<std::string>();
        report(std::string("/") + key, Part::value, fmt::format("\"{}\" is no short text", key),
               fmt::format("expected a text of at most {} bytes", longest));
        return {};
    }
    double number(const json& object, const std::string& at, const char* key, double low, double high) {
        const json* value = find(object, at, key);
        if (value == nullptr) return low;
        const double x = value->is_number() ? value->get<double>() : std::nan("");
        if (x >= low && x <= high) return x;
        report(at + "/" + key, Part::value, fmt::format("\"{}\" cannot be {}", key, in_quotes(value->dump())),
               fmt::format("expected a number from {} to {}", low, high));
        return low;
    }
    bool flag(const json& object, const char* key) {
        const json* value = find(object, "", key);
        if (value == nullptr) return false;
        if (value->is_boolean()) return value->get<bool>();
        report(std::string("/") + key, Part::value,
               fmt::format("\"{}\" cannot be {}", key, in_quotes(value->dump())), "expected true or false");
        return false;
    }
    void only(const json& object, const std::string& at, const std::vector<std::string>& known) {
        for (const auto& [key, value] : object.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                report(at + "/" + pointer_token(key), Part::key,
                       fmt::format("{} is not known here", in_quotes(key)), suggest(key, known));
    }
};

}  // namespace bolt::content
