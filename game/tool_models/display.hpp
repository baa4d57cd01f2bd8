// The display of an electronic torque wrench: a number of four digits with seven segments each, and two rings
// of light. Every segment and ring is a node of its own: to show a reading, a program hides those that are
// off.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "game/tool_models/parts.hpp"

namespace bolt::tool_models {

struct DisplayReading {
    double value = 0.0;                      // shown with one decimal place, 0 to 999.9
    bool reached = false, exceeded = false;  // the ring of light that is on, if any
};

// A node of the display. `digit`: from 0, the hundreds, to 3, the tenths. `segment`: from 0 at the top,
// clockwise to 5, and 6 in the middle.
struct DisplayElement {
    // `point`: the decimal point. `reached`, `exceeded`: the rings of light.
    enum class Kind : std::uint8_t { segment, point, reached, exceeded };
    Kind kind = Kind::point;
    int digit = 0, segment = 0;
};

// The element whose node has this name; none: the node is not a part of a display.
std::optional<DisplayElement> display_element(std::string_view node);

// Returns true if the element is visible with this reading. Leading zeros before the units are not.
bool is_on(const DisplayElement& element, const DisplayReading& reading);

// The parts of the number on a screen from x = `from` to `to` whose face is at the height z. Millimetres.
ToolModelParts number_parts(double from, double to, double z);

// The two rings of light around a handle along +X, next to each other before a part that begins at x, mm.
ToolModelParts light_parts(double x, Detail detail);

}  // namespace bolt::tool_models
