// What hands at mouse and keyboard want: the camera moved, and things done.
#pragma once

#include <optional>
#include <span>

#include "engine/platform/input.hpp"
#include "game/view/camera.hpp"

namespace bolt::author {

struct Wishes {
    bool close = false, full_screen = false, reload = false, all = false, other_level = false;
    bool redraw = false;  // the window needs its picture again
    std::optional<std::size_t> view;
};

class Hands {
  public:
    // `height`: of the window, pixels; `aspect`: width over height.
    Wishes apply(std::span<const platform::Event> events, double height, double aspect, view::Orbit& camera,
                 const render::BoundingBox& box);

  private:
    enum class Drag : std::uint8_t { none, turn, pan };
    Drag drag_ = Drag::none;
    platform::Button held_ = platform::Button::other;
    glm::dvec2 cursor_{0.0};
};

// One line: which key does what.
std::string help(const std::vector<view::Viewpoint>& views);

}  // namespace bolt::author
