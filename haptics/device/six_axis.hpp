// A puck or ball that is pushed and turned about six axes and springs back (SpaceMouse class). Which bits say
// so stands in its report descriptor; some send all axes in one report, some pushes and turns in two.
#pragma once

#include <array>
#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

struct SixAxisLayout {
    std::array<Field, 6> axes;   // x, y, z, then the turns about them
    std::vector<Field> buttons;  // in the order of their numbers
    bool numbered = false;
};

// As the puck stands: −1 … 1 each, in the device's own frame (3Dconnexion: x right, y towards the user, z
// down; turns right-handed).
struct SixAxisState {
    std::array<double, 6> share{};
    std::uint32_t buttons = 0;  // a bit each
};

// An error: the device is none of this class.
Result<SixAxisLayout> six_axis_layout(const ReportDescriptor& descriptor);

// Takes an input report as hidapi gives it, with its id in front where reports are numbered. False: it tells
// nothing that is looked for, or is too short.
bool take_report(const SixAxisLayout& layout, std::span<const std::uint8_t> report, SixAxisState& state);

}  // namespace bolt::device
