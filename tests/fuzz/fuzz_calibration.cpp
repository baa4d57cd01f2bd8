// Stored calibrations: any bytes give a calibration that survives a write and read, or an error with a
// position, never a crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/trainee/glove_calibration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto read = bolt::content::parse_glove_calibration(text, "fuzz.json");
    if (!read) {
        if (read.error().line < 1 || read.error().what.empty()) std::abort();
        return 0;
    }
    for (const auto& line : read->calibration.fits)
        if (line && !std::isfinite(bolt::hand::angle(*line, 255.0))) std::abort();
    const std::string written = bolt::content::glove_calibration_text(*read);
    const auto again = bolt::content::parse_glove_calibration(written, "fuzz.json");
    if (!again || bolt::content::glove_calibration_text(*again) != written) std::abort();
    return 0;
}
