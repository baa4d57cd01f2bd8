#include "game/trainer/ui_input.hpp"

#include <optional>

#include "engine/text/utf8.hpp"

namespace bolt::trainer {

namespace {

using PlatformKey = platform::Key;

std::optional<ui::Key> key_of(PlatformKey key) {
    constexpr std::pair<PlatformKey, ui::Key> table[] = {{PlatformKey::tab, ui::Key::tab},
                                                         {PlatformKey::left, ui::Key::left},
                                                         {PlatformKey::right, ui::Key::right},
                                                         {PlatformKey::up, ui::Key::up},
                                                         {PlatformKey::down, ui::Key::down},
                                                         {PlatformKey::page_up, ui::Key::page_up},
                                                         {PlatformKey::page_down, ui::Key::page_down},
                                                         {PlatformKey::home, ui::Key::home},
                                                         {PlatformKey::end, ui::Key::end},
                                                         {PlatformKey::insert, ui::Key::insert},
                                                         {PlatformKey::del, ui::Key::erase},
                                                         {PlatformKey::backspace, ui::Key::backspace},
                                                         {PlatformKey::space, ui::Key::space},
                                                         {PlatformKey::enter, ui::Key::enter},
                                                         {PlatformKey::escape, ui::Key::escape},
                                                         {PlatformKey::a, ui::Key::a},
                                                         {PlatformKey::c, ui::Key::c},
                                                         {PlatformKey::v, ui::Key::v},
                                                         {PlatformKey::x, ui::Key::x},
                                                         {PlatformKey::y, ui::Key::y},
                                                         {PlatformKey::z, ui::Key::z}};
    for (const auto& [from, to] : table)
        if (from == key) return to;
    return std::nullopt;
}

void feed_key(ui::Input& input, const platform::KeyEvent& event) {
    input.ctrl = event.modifiers.control;
    input.shift = event.modifiers.shift;
    input.alt = event.modifiers.alt;
    if (const auto key = key_of(event.key)) input.key(*key) = event.down;
}

void feed_button(ui::Input& input, const platform::ButtonEvent& event) {
    input.pointer = event.at;
    input.pointing = true;
    const auto index = event.button == platform::Button::left     ? 0U
                       : event.button == platform::Button::right  ? 1U
                       : event.button == platform::Button::middle ? 2U
                                                                  : 3U;
    if (index >= input.buttons.size()) return;
    input.buttons.at(index).down = event.down;
    input.buttons.at(index).pressed = input.buttons.at(index).pressed || event.down;
}

}  // namespace

void feed(ui::Input& input, std::span<const platform::Event> events) {
    for (ui::Button& button : input.buttons) button.pressed = false;
    input.wheel = {};
    input.text.clear();
    for (const platform::Event& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event)) {
            feed_key(input, *key);
        } else if (const auto* typed = std::get_if<platform::TextEvent>(&event)) {
            input.text += text::encode(std::u32string_view(&typed->letter, 1));
        } else if (const auto* button = std::get_if<platform::ButtonEvent>(&event)) {
            feed_button(input, *button);
        } else if (const auto* cursor = std::get_if<platform::CursorEvent>(&event)) {
            input.pointer = cursor->at;
            input.pointing = true;
        } else if (const auto* wheel = std::get_if<platform::WheelEvent>(&event)) {
            input.wheel += glm::vec2(wheel->by);
        } else if (const auto* focus = std::get_if<platform::FocusEvent>(&event)) {
            if (focus->here) continue;
            input.keys = {};
            for (ui::Button& held : input.buttons) held.down = false;
            input.ctrl = input.shift = input.alt = false;
        }
    }
}

}  // namespace bolt::trainer
