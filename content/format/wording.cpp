#include "content/format/wording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/nearest.hpp"

namespace bolt::content {

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string shown = "\"";
    std::size_t end = text.size();
    if (end > longest) {
        end = longest;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
            --end;  // not inside a character
    }
    for (const char c : text.substr(0, end)) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte < 0x20 || byte == 0x7F ? '?' : c;
    }
    return shown + (end < text.size() ? "\"..." : "\"");
}

std::string meant(std::string_view name, std::span<const std::string> known) {
    std::string best = nearest(name, known);
    if (best.empty()) return best;
    const std::size_t distance = edit_distance(name, best);
    if (distance >= name.size()) return {};  // not a letter in common
    const bool alone = std::none_of(known.begin(), known.end(), [&](const std::string& other) {
        return other != best && edit_distance(name, other) <= distance;
    });
    return alone ? best : std::string{};
}

std::string suggest(std::string_view name, std::span<const std::string> known) {
    const std::string best = meant(name, known);
    if (!best.empty()) return fmt::format("did you mean {}?", in_quotes(best));
    constexpr std::size_t most = 20;  // more names help nobody
    if (known.size() > most)
        return fmt::format("expected one of {}, ...", fmt::join(known.subspan(0, most), ", "));
    if (known.size() == 1) return fmt::format("expected {}", in_quotes(known.front()));
    return fmt::format("expected one of {}", fmt::join(known, ", "));
}

}  // namespace bolt::content
