// Calibration files: any bytes give a calibration or an error with a line number, never a crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "haptics/hand/glove_calibration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto calibration = bolt::hand::parse_cal(text, "fuzz.cal");
    if (!calibration) {
        if (calibration.error().line < 1) std::abort();
        return 0;
    }
    for (const auto& fit : calibration->fits)
        if (fit && !std::isfinite(bolt::hand::angle(*fit, 255.0))) std::abort();
    return 0;
}
