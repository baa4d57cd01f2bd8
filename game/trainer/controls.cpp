#include "game/trainer/controls.hpp"

namespace bolt::trainer {

namespace {

using namespace platform;

void press(const Controls& controls, const KeyEvent& key, Wanted& wanted) {
    const Modifiers& m = key.modifiers;
    if (!key.down || key.repeated || m.control || m.alt || m.super || key.key == Key::unknown) return;
    if (key.key == Key::escape) wanted.actions.at(static_cast<std::size_t>(Action::pause)) = true;
    for (std::size_t i = 0; i < action_count; ++i)
        if (controls.keys.keys.at(i) == key.key) wanted.actions.at(i) = true;
}

void click(Controls& controls, const ButtonEvent& button, const Mine& mine, Wanted& wanted) {
    controls.pointer = button.at;
    // Let go of it may be anywhere; pressed on the menu it is the menu's.
    if (button.down && !mine.pointer) return;
    if (button.button == Button::left) {
        controls.left = button.down;
        if (button.down) wanted.pressed = button.at;
    }
    if (button.button == Button::middle) controls.middle = button.down;
    if (button.button == Button::right) controls.right = button.down;
}

}  // namespace

Wanted apply(Controls& controls, std::span<const Event> events, const Mine& mine) {
    Wanted wanted;
    for (const Event& event : events) {
        if (const auto* key = std::get_if<KeyEvent>(&event)) {
            if (mine.keys) press(controls, *key, wanted);
        } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
            click(controls, *button, mine, wanted);
        } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
            const glm::dvec2 way = cursor->at - controls.pointer;
            controls.pointer = cursor->at;
            if (controls.left)
                wanted.dragged += way;
            else if (controls.right)
                wanted.turned += way;
            else if (controls.middle)
                wanted.moved += way;
        } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
            if (mine.pointer) wanted.wheel += wheel->by.y;
        } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
            // A button may be let go of where we do not hear it: a hand must not go on pulling.
            if (!focus->here) controls.left = controls.middle = controls.right = false;
        } else if (std::holds_alternative<CloseEvent>(event)) {
            wanted.close = true;
        }
    }
    wanted.left = controls.left;
    wanted.pointer = controls.pointer;
    return wanted;
}

}  // namespace bolt::trainer
