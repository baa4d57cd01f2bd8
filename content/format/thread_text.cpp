#include "content/format/thread_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "content/format/wording.hpp"

namespace bolt::content {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// "m 12 × 1,75" as parse_thread would have it: "M12x1.75".
std::string normalised(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, char>, 9> ways = {{{"\u00D7", 'x'},  // ×
                                                                        {"X", 'x'},
                                                                        {"*", 'x'},
                                                                        {",", '.'},
                                                                        {"m", 'M'},
                                                                        {"\u00A0", ' '},  // spaces that
                                                                        {"\u2009", ' '},  // do not break
                                                                        {"\u202F", ' '},
                                                                        {"\t", ' '}}};
    std::string result;
    bool gap = false;  // a space was read over
    while (!text.empty()) {
        const auto* const way =
            std::find_if(ways.begin(), ways.end(), [&](const auto& w) { return text.starts_with(w.first); });
        const char c = way != ways.end() ? way->second : text.front();
        text.remove_prefix(way != ways.end() ? way->first.size() : 1);
        if (c == ' ') {
            gap = true;
            continue;
        }
        // Two numbers with a space between them do not become one.
        if (gap && is_digit(c) && !result.empty() && is_digit(result.back())) result += 'x';
        gap = false;
        result += c;
    }
    return result;
}

// The first number of a text: the diameter.
std::string_view first_number(std::string_view text) {
    const auto in_number = [](char c) { return is_digit(c) || c == '.'; };
    const auto* const begin = std::find_if(text.begin(), text.end(), is_digit);
    const auto* const end = std::find_if_not(begin, text.end(), in_number);
    return {begin, end};
}

}  // namespace

Result<joint::ThreadSize> read_thread(std::string_view text) {
    auto thread = joint::parse_thread(text);
    if (thread) return thread;
    const std::string meant_text = normalised(text);
    const auto normal = joint::parse_thread(meant_text);
    std::string what = fmt::format("{} is no thread that we know", in_quotes(text));
    if (normal)
        return fail(ErrorCode::bad_content, std::move(what), fmt::format("did you mean \"{}\"?", meant_text));
    const auto sizes = joint::fastener_sizes();
    const std::string_view name = std::string_view(meant_text).substr(0, meant_text.find('x'));
    if (std::any_of(sizes.begin(), sizes.end(), [&](const auto& size) { return size.name == name; }))
        return fail(ErrorCode::bad_content, std::move(what), normal.error().expected);  // its pitches
    std::vector<std::string> same;
    for (std::string& known : joint::thread_names())
        if (first_number(known) == first_number(meant_text)) same.push_back(std::move(known));
    const std::string best = meant(meant_text, same);
    return fail(ErrorCode::bad_content, fmt::format("{} is no thread size that we know", in_quotes(text)),
                best.empty() ? "one of M4 to M39, a fine pitch as in \"M16x1.5\""
                             : fmt::format("did you mean {}?", in_quotes(best)));
}

}  // namespace bolt::content
