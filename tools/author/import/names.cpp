#include "tools/author/import/names.hpp"

#include <algorithm>
#include <cctype>

#include "engine/base/wildcard.hpp"

namespace bolt::step_import {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool digits(std::string_view text) {
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Length in bytes of the well-formed UTF-8 sequence at the start of `text`; 0 if it is not well-formed
// (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text) {
    const auto at = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
    };
    const auto tail = [&](std::size_t i) { return (at(i) & 0xC0U) == 0x80U; };
    const unsigned first = at(0), second = at(1);
    if (first < 0x80U) return 1;
    if (first >= 0xC2U && first <= 0xDFU && tail(1)) return 2;
    if (first >= 0xE0U && first <= 0xEFU && tail(1) && tail(2) && (first != 0xE0U || second >= 0xA0U) &&
        (first != 0xEDU || second < 0xA0U))
        return 3;
    if (first >= 0xF0U && first <= 0xF4U && tail(1) && tail(2) && tail(3) &&
        (first != 0xF0U || second >= 0x90U) && (first != 0xF4U || second < 0x90U))
        return 4;
    return 0;
}

}  // namespace

std::string clean_name(std::string_view text) {
    std::string clean;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0)
            clean += "\xEF\xBF\xBD";
        else if (length > 1 || (static_cast<unsigned char>(text[0]) >= 0x20U && text[0] != '\x7F'))
            clean += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    const std::size_t first = clean.find_first_not_of(' ');
    if (first == std::string::npos) return {};
    return clean.substr(first, clean.find_last_not_of(' ') - first + 1);
}

bool is_meaningful_name(std::string_view name) {
    if (name.empty() || digits(name) || name.starts_with("=>[") ||
        name.starts_with("Open CASCADE STEP translator"))
        return false;
    for (const std::string_view generic : {"SOLID", "SHELL", "COMPOUND", "COMPSOLID", "FACE", "PART",
                                           "ASSEMBLY", "COMPONENT", "NONE", "NAUO"}) {
        if (name.size() < generic.size()) continue;
        if (!std::equal(generic.begin(), generic.end(), name.begin(),
                        [](char a, char b) { return lower(a) == lower(b); }))
            continue;
        std::string_view rest = name.substr(generic.size());
        while (!rest.empty() && (rest[0] == '_' || rest[0] == ' ' || rest[0] == '-')) rest.remove_prefix(1);
        if (rest.empty() || digits(rest)) return false;
    }
    return true;
}

std::string UniqueNames::claim(std::string_view name) {
    const std::string base = name.empty() ? "part" : std::string(name);
    std::string free = base;
    for (int i = 2; !used_.insert(free).second; ++i) free = base + "_" + std::to_string(i);
    if (free != base) ++renamed_;
    return free;
}

bool matches(std::string_view pattern, std::string_view name) {
    return matches_wildcard(pattern, name, [](char p, char n) { return lower(p) == lower(n); });
}

}  // namespace bolt::step_import
