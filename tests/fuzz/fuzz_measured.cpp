// Measured records: any bytes give a record or an error with a line number, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "game/analysis/measured.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto measured = bolt::analysis::parse_measured(text, "fuzz.csv");
    if (!measured && measured.error().message().empty()) std::abort();
    return 0;
}
