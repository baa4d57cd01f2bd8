// Language files: any bytes give texts that can be formatted, or errors that each have a line, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/words/words.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const bolt::words::LoadedWords loaded = bolt::words::parse_words(text, "fuzz.json");
    for (const bolt::Error& error : loaded.errors)
        if (error.line < 1 || error.what.empty()) std::abort();
    for (std::size_t i = 0; loaded.ok() && i < bolt::words::key_count; ++i) {
        const auto key = bolt::words::TextKey::at(i);
        if (loaded.lines[i] < 1 || bolt::words::format_text(loaded.words, key) != loaded.words[key])
            std::abort();
    }
    return 0;
}
