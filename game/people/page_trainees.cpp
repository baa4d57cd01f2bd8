#include "game/people/page_trainees.hpp"

#include <array>
#include <utility>

#include "game/plot/html.hpp"

namespace bolt::people {

namespace {

constexpr std::string_view entry_start = "<meta name=\"boltwright-person\" content=\"", entry_end = "\"/>";

std::string unescaped(std::string_view html) {
    constexpr std::array<std::pair<std::string_view, char>, 6> entities{
        {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}, {"&apos;", '\''}}};
    std::string text;
    while (!html.empty()) {
        std::size_t length = 1;
        char c = html.front();
        for (const auto& [entity, value] : entities)
            if (html.starts_with(entity)) length = entity.size(), c = value;
        text += c;
        html.remove_prefix(length);
    }
    return text;
}

// The texts between each `before` and the next `after`.
std::vector<std::string> texts_between(std::string_view html, std::string_view before,
                                       std::string_view after) {
    std::vector<std::string> texts;
    for (std::size_t at = html.find(before); at != std::string_view::npos; at = html.find(before, at)) {
        at += before.size();
        const std::size_t end = html.find(after, at);
        if (end == std::string_view::npos) break;
        texts.push_back(unescaped(html.substr(at, end - at)));
        at = end;
    }
    return texts;
}

bool is_simulated(std::string_view trainee) {
    return trainee.ends_with(')') && trainee.find(" (simulated") != std::string_view::npos;
}

}  // namespace

std::string people_list(const std::set<std::string>& people) {
    std::string out;
    for (const std::string& person : people)
        out.append(entry_start).append(plot::escape(person)).append(entry_end).append("\n");
    return out;
}

std::optional<std::vector<std::string>> page_trainees(std::string_view html) {
    const std::string_view head = html.substr(0, html.find("</head>"));
    if (head.find("training report</title>") == std::string_view::npos) return std::nullopt;
    auto trainees = texts_between(head, entry_start, entry_end);
    if (!trainees.empty()) return trainees;
    trainees = texts_between(html, "<dt>trainee</dt><dd>", "</dd>");
    if (trainees.empty()) return std::nullopt;
    std::erase_if(trainees, is_simulated);
    for (std::string& trainee : trainees)
        if (trainee == "person without a name" || trainee.ends_with("not recorded)")) trainee.clear();
    return trainees;
}

}  // namespace bolt::people
