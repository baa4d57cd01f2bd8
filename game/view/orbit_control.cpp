#include "game/view/window.hpp"

namespace bolt::view {

void OrbitControl::stop() {
    drag_ = Drag::none;
    held_ = platform::Button::other;
}

bool OrbitControl::apply(std::span<const platform::InputEvent> events, const PictureShape& picture,
                         Orbit& orbit, const render::BoundingBox& box) {
    using namespace platform;
    bool moved = false;
    for (const InputEvent& event : events) {
        if (const auto* button = std::get_if<ButtonEvent>(&event)) {
            cursor_ = button->at;
            // A second button is ignored while one is held.
            if (button->down && drag_ == Drag::none && button->button != Button::other) {
                drag_ = button->button == Button::left ? Drag::turn : Drag::pan;
                held_ = button->button;
            } else if (!button->down && button->button == held_) {
                stop();
            }
        } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
            const glm::dvec2 motion = (cursor->at - cursor_) / picture.height;
            cursor_ = cursor->at;
            if (drag_ == Drag::turn) turn(orbit, {motion.x, -motion.y});
            if (drag_ == Drag::pan) pan(orbit, {motion.x, -motion.y});
            moved = moved || drag_ != Drag::none;
        } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
            const glm::dvec2 at(wheel->at.x / picture.height - 0.5 * picture.aspect,
                                0.5 - wheel->at.y / picture.height);
            zoom(orbit, wheel->notches.y, at, box);
            moved = true;
        } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
            if (!focus->focused) stop();  // the release may go to another window
        }
    }
    return moved;
}

}  // namespace bolt::view
