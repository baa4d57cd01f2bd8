#include "game/plot/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bolt::plot {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";
constexpr std::string_view minus = "\xE2\x88\x92";

bool continues(std::string_view text, std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
}

// Length of the well-formed UTF-8 sequence at `at`, 0 if there is none (overlong forms and surrogates are
// none).
std::size_t sequence_length(std::string_view text, std::size_t at) {
    const auto lead = static_cast<unsigned char>(text[at]);
    if (lead < 0x80U) return 1;
    if (lead < 0xC2U || lead > 0xF4U) return 0;
    const std::size_t length = lead < 0xE0U ? 2 : lead < 0xF0U ? 3 : 4;
    for (std::size_t i = 1; i < length; ++i)
        if (!continues(text, at + i)) return 0;
    const auto second = static_cast<unsigned char>(text[at + 1]);
    const bool overlong = (lead == 0xE0U && second < 0xA0U) || (lead == 0xF0U && second < 0x90U);
    const bool beyond = (lead == 0xEDU && second > 0x9FU) || (lead == 0xF4U && second > 0x8FU);
    return overlong || beyond ? 0 : length;
}

void append_ascii(std::string& out, char c) {
    switch (c) {
        case '&':
            out += "&amp;";
            return;
        case '<':
            out += "&lt;";
            return;
        case '>':
            out += "&gt;";
            return;
        case '"':
            out += "&quot;";
            return;
        case '\'':
            out += "&#39;";
            return;
        default:
            break;
    }
    const bool forbidden = static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t' && c != '\r';
    if (forbidden || c == '\x7F')
        out += replacement;
    else
        out += c;
}

std::string with_minus(std::string digits) {
    if (digits.empty() || digits.front() != '-') return digits;
    const bool zero = digits.find_first_of("123456789") == std::string::npos;
    digits.erase(0, 1);
    return zero ? digits : std::string(minus) + digits;
}

}  // namespace

std::string escape(std::string_view text) {
    std::string out;
    out.reserve(text.size() + text.size() / 8);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = sequence_length(text, i);
        if (length == 0)
            out += replacement;
        else if (length == 1)
            append_ascii(out, text[i]);
        else
            out += text.substr(i, length);
        i += length == 0 ? 1 : length;
    }
    return out;
}

std::string number(double value, int decimals) {
    if (!std::isfinite(value)) return "\xE2\x80\x93";
    return with_minus(fmt::format("{:.{}f}", value, decimals));
}

std::string signed_number(double value, int decimals) {
    const std::string text = number(value, decimals);
    const bool plus = value > 0.0 && text.find_first_of("123456789") != std::string::npos;
    return plus ? "+" + text : text;
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return number(seconds, 0);
    if (seconds < 59.95) return number(seconds, 1) + " s";
    const double whole = std::round(seconds);
    const double minutes = std::floor(whole / 60.0);
    const double rest = whole - 60.0 * minutes;
    if (minutes < 60.0) return fmt::format("{:.0f} min {:02.0f} s", minutes, rest);
    const double hours = std::floor(minutes / 60.0);
    return fmt::format("{:.0f} h {:02.0f} min {:02.0f} s", hours, minutes - 60.0 * hours, rest);
}

}  // namespace bolt::plot
