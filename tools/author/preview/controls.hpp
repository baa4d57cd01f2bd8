// Maps mouse and keyboard events of the preview window to camera motion and commands.
#pragma once

#include <optional>
#include <span>

#include "engine/platform/input.hpp"
#include "game/view/window.hpp"

namespace bolt::author {

struct PreviewCommands {
    bool close = false, full_screen = false, reload = false, show_all = false, toggle_level = false;
    bool toggle_sectors = false;  // of all joints
    bool next_problem = false, next_variant = false, toggle_panel = false;
    bool redraw = false;                     // the window lost its picture or was resized
    std::optional<std::size_t> select_view;  // index of a view of the assembly
    // Pixels from the upper left corner, where the left button was pressed and released without a drag.
    std::optional<glm::dvec2> click;
};

class PreviewControls {
  public:
    // Moves `camera` and returns the commands of the events. `height`: of the window, pixels; `aspect`: width
    // / height; `box`: of the model.
    PreviewCommands apply(std::span<const platform::InputEvent> events, double height, double aspect,
                          view::Orbit& camera, const render::BoundingBox& box);

  private:
    // Returns the position of a click that ends with the event.
    std::optional<glm::dvec2> find_click(const platform::InputEvent& event);

    view::OrbitControl mouse_;
    std::optional<glm::dvec2> pressed_;  // of the left button; none: not held, or the mouse has moved since
};

// Returns one line that lists the keys and the names of up to nine views.
std::string help_line(const std::vector<view::Viewpoint>& views);

}  // namespace bolt::author
