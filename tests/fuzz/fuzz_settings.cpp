// Stored settings: any bytes give settings that survive a write and read, or an error with a position, never
// a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/trainee/settings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const bolt::content::SettingsVocabulary known{
        {"de", "en", "zh"}, {"hint", "pause", "tool"}, {"Escape", "F1", "H", "T"}, {{"Escape", "pause"}}};
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto read = bolt::content::parse_settings(text, "fuzz.json", known);
    if (!read) {
        if (read.error().line < 1 || read.error().what.empty()) std::abort();
        return 0;
    }
    const bool fits = read->volume >= 0.0 && read->volume <= 1.0 && read->vibration >= 0.0 &&
                      read->vibration <= 1.0 && read->force_scale >= 0.1 && read->force_scale <= 1.0 &&
                      (!read->seated_eye_height || *read->seated_eye_height <= 1.5);
    if (!fits) std::abort();
    const std::string written = bolt::content::settings_text(*read);
    const auto again = bolt::content::parse_settings(written, "fuzz.json", known);
    if (!again || bolt::content::settings_text(*again) != written) std::abort();
    return 0;
}
