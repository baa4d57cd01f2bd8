// Checks of a display file that go beyond the form of its members. All are pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "content/displays/display_file.hpp"

namespace bolt::content {

struct DisplayFinding {
    // True: the picture would be wrong or could not be shown. False: it is shown, but probably not as
    // intended.
    bool prevents_use = false;
    std::string text;
    // Index of the wall; with two walls, that of the later one. None: the finding is about the whole file.
    std::optional<std::size_t> wall{};
};

// A monitor of a DisplayHost, and where it is on the desktop. The values are those of a platform::Monitor, a
// type that this layer may not include.
struct HostMonitor {
    std::string name;
    int x = 0, y = 0, width = 0, height = 0;  // pixels, y down
    bool operator==(const HostMonitor&) const = default;
};

// The monitor that an output fills; null: the output is shown in a window, or there is no such monitor.
const HostMonitor* find_monitor(const DisplayOutput& output, std::span<const HostMonitor> monitors);

// Tolerances of the checks.
inline constexpr double right_angle_tolerance = to_radians(0.5);
inline constexpr double min_wall_edge = 0.05;        // m; a shorter edge is a mistake
inline constexpr double max_wall_edge = 100.0;       // m; a longer one is probably not in metres
inline constexpr double min_viewer_distance = 0.05;  // m, of the head from a wall
inline constexpr double wall_tolerance = 0.01;       // m, by which walls may cross or overlap
inline constexpr double seam_tolerance = 0.001;      // m, of a gap between walls that meet
inline constexpr double max_seam_gap = 0.05;         // m, of the widest gap that is taken for a seam
inline constexpr double pixel_tolerance = 0.01;      // by which width / height of a pixel may differ from 1
inline constexpr double narrow_eyes = 0.05, wide_eyes = 0.08;  // m; nearly all adults are between these

// Checks names, shapes, crossings, overlaps and seams of the walls, whether the fixed head is in front of
// each wall, and the eye separation.
std::vector<DisplayFinding> check_walls(const DisplayFile& displays);

// The computer, or the X display of a computer, that a check is for. Each process of the program shows the
// walls of one DisplayHost.
struct DisplayHost {
    std::vector<HostMonitor> monitors;  // none: outputs are compared with one another only
    int process = 0;                    // number of the process (DisplayOutput::process)
    std::string display;                // X display of the program, such as ":0"; empty: unknown
    int processes = 1;                  // number of processes that show the walls together
};

// Returns true for names of the same X screen: ":0" is ":0.0".
bool is_same_display(std::string_view a, std::string_view b);

// Checks the floor, the height of the head, and the size of the text on the panel of menus and hints.
std::vector<DisplayFinding> check_viewing(const DisplayFile& displays);

// Checks the shapes of pixels, and finds outputs that use the same pixels, that are outside the monitors of
// `host`, or that are on another X display than the program.
std::vector<DisplayFinding> check_outputs(const DisplayFile& displays, const DisplayHost& host = {});

// The findings of check_walls(), check_viewing() and check_outputs(); those that prevent the use come first.
// If a finding of check_walls() prevents the use, check_viewing() is left out.
std::vector<DisplayFinding> check_displays(const DisplayFile& displays, const DisplayHost& host = {});

// Returns one line for each finding. It begins with the file and, if the finding is about a wall, with the
// wall's line and column.
std::string describe(std::span<const DisplayFinding> findings, const LoadedDisplays& loaded);

}  // namespace bolt::content
