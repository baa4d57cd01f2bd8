// Display files: any bytes give a file that survives a write and read to the same bits, and that all checks
// take, or errors with positions, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/displays/check_displays.hpp"
#include "content/displays/test_pattern.hpp"
#include "content/displays/wall_summary.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt::content;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const LoadedDisplays read = parse_displays(text, "fuzz.json");
    if (!read.ok()) {
        for (const bolt::Error& error : read.errors)
            if (error.line < 1 || error.what.empty()) std::abort();
        return 0;
    }
    const DisplayFile& displays = read.displays;
    if (displays.walls.empty() || displays.walls.size() > max_walls ||
        read.wall_positions.size() != displays.walls.size())
        std::abort();
    const DisplayHost host{{{"DP-1", 0, 0, 1920, 1080}}, 0, ":0"};
    for (const DisplayFinding& finding : check_displays(displays, host))
        if (finding.text.empty() || finding.wall.value_or(0) >= displays.walls.size()) std::abort();
    if (list_walls(displays, host).empty()) std::abort();
    for (const Wall& wall : displays.walls) {
        if (wall.right_output.has_value() != (wall.stereo == StereoMode::two_outputs)) std::abort();
        for (const PatternLine& line : test_pattern(wall, PatternEye::left, 7).lines)
            if (!bolt::finite(pattern_point(wall, line.from))) std::abort();
    }
    const LoadedDisplays again = parse_displays(displays_json(displays), "fuzz.json");
    if (!again.ok() || again.displays != displays) std::abort();
    return 0;
}
