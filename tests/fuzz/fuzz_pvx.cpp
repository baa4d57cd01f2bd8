// ParaView's .pvx files: any bytes give a display file that can be written and read, or errors with
// positions, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/displays/check_displays.hpp"
#include "content/displays/import_pvx.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt::content;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const ImportedDisplays read = import_pvx(text, "fuzz.pvx");
    for (const auto* messages : {&read.errors, &read.warnings})
        for (const bolt::Error& message : *messages)
            if (message.line < 1 || message.column < 1 || message.what.empty()) std::abort();
    if (!read.ok()) return 0;
    (void)check_displays(read.displays);
    const LoadedDisplays again = parse_displays(displays_json(read.displays), "fuzz.json");
    if (!again.ok() || again.displays != read.displays) std::abort();
    return 0;
}
