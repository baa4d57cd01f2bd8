#include "game/trainer/controls.hpp"

#include <algorithm>
#include <optional>

#include "engine/text/layout.hpp"

namespace bolt::trainer {

namespace {

using namespace platform;

void press(const InputState& state, const KeyEvent& key, FrameInput& input) {
    const Modifiers& m = key.modifiers;
    if (!key.down || key.repeated || m.control || m.alt || m.super || key.key == Key::unknown) return;
    if (key.key == Key::escape) input.actions.at(static_cast<std::size_t>(Action::pause)) = true;
    for (std::size_t i = 0; i < action_count; ++i)
        if (state.keys.keys.at(i) == key.key) input.actions.at(i) = true;
}

void press_button(InputState& state, const ButtonEvent& button, const InputFocus& focus, FrameInput& input) {
    state.pointer = button.at;
    // A release counts anywhere; a press on a menu belongs to the menu.
    if (button.down && !focus.pointer) return;
    if (button.button == Button::left) {
        state.left = button.down;
        if (button.down) input.pressed_at = button.at;
    }
    if (button.button == Button::middle) state.middle = button.down;
    if (button.button == Button::right) state.right = button.down;
}

}  // namespace

FrameInput apply_events(InputState& state, std::span<const InputEvent> events, const InputFocus& focus) {
    FrameInput input;
    for (const InputEvent& event : events) {
        if (const auto* key = std::get_if<KeyEvent>(&event)) {
            if (focus.keys) press(state, *key, input);
        } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
            press_button(state, *button, focus, input);
        } else if (const auto* controller = std::get_if<ControllerEvent>(&event)) {
            if (focus.keys && controller->down && controller->button == ControllerButton::start)
                input.actions.at(static_cast<std::size_t>(Action::pause)) = true;
        } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
            const glm::dvec2 movement = cursor->at - state.pointer;
            state.pointer = cursor->at;
            if (state.left && state.right) input.turn_drag += movement;
            if (state.left)
                input.left_drag += movement;
            else if (state.right)
                input.right_drag += movement;
            else if (state.middle)
                input.middle_drag += movement;
        } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
            if (focus.pointer) input.scroll += wheel->notches.y;
        } else if (const auto* focus_event = std::get_if<platform::FocusEvent>(&event)) {
            // A release outside the window is not reported; without this a hand would keep pulling.
            if (!focus_event->focused) state.left = state.middle = state.right = false;
        } else if (std::holds_alternative<CloseEvent>(event)) {
            input.close_requested = true;
        }
    }
    input.left_down = state.left;
    input.pointer = state.pointer;
    return input;
}

namespace {

using PlatformKey = platform::Key;

std::optional<ui::UiKey> key_of(PlatformKey key) {
    constexpr std::pair<PlatformKey, ui::UiKey> table[] = {{PlatformKey::tab, ui::UiKey::tab},
                                                           {PlatformKey::left, ui::UiKey::left},
                                                           {PlatformKey::right, ui::UiKey::right},
                                                           {PlatformKey::up, ui::UiKey::up},
                                                           {PlatformKey::down, ui::UiKey::down},
                                                           {PlatformKey::page_up, ui::UiKey::page_up},
                                                           {PlatformKey::page_down, ui::UiKey::page_down},
                                                           {PlatformKey::home, ui::UiKey::home},
                                                           {PlatformKey::end, ui::UiKey::end},
                                                           {PlatformKey::insert, ui::UiKey::insert},
                                                           {PlatformKey::delete_key, ui::UiKey::delete_key},
                                                           {PlatformKey::backspace, ui::UiKey::backspace},
                                                           {PlatformKey::space, ui::UiKey::space},
                                                           {PlatformKey::enter, ui::UiKey::enter},
                                                           {PlatformKey::escape, ui::UiKey::escape},
                                                           {PlatformKey::a, ui::UiKey::a},
                                                           {PlatformKey::c, ui::UiKey::c},
                                                           {PlatformKey::v, ui::UiKey::v},
                                                           {PlatformKey::x, ui::UiKey::x},
                                                           {PlatformKey::y, ui::UiKey::y},
                                                           {PlatformKey::z, ui::UiKey::z}};
    for (const auto& [from, to] : table)
        if (from == key) return to;
    return std::nullopt;
}

void update_key(ui::UiInput& input, const platform::KeyEvent& event) {
    input.ctrl = event.modifiers.control;
    input.shift = event.modifiers.shift;
    input.alt = event.modifiers.alt;
    if (const auto key = key_of(event.key)) input.key(*key).set(event.down);
}

// A controller moves through the interface as the arrow keys do.
void update_controller(ui::UiInput& input, const platform::ControllerEvent& event) {
    using platform::ControllerButton;
    constexpr std::pair<ControllerButton, ui::UiKey> table[] = {
        {ControllerButton::up, ui::UiKey::up},
        {ControllerButton::down, ui::UiKey::down},
        {ControllerButton::left, ui::UiKey::left},
        {ControllerButton::right, ui::UiKey::right},
        {ControllerButton::confirm, ui::UiKey::space}};
    for (const auto& [button, key] : table)
        if (button == event.button) input.key(key).set(event.down);
}

void update_button(ui::UiInput& input, const platform::ButtonEvent& event) {
    input.pointer = event.at;
    input.pointer_inside = true;
    const auto index = event.button == platform::Button::left     ? 0U
                       : event.button == platform::Button::right  ? 1U
                       : event.button == platform::Button::middle ? 2U
                                                                  : 3U;
    if (index >= input.buttons.size()) return;
    input.buttons.at(index).set(event.down);
}

}  // namespace

bool is_back(const platform::InputEvent& event) {
    if (const auto* controller = std::get_if<platform::ControllerEvent>(&event))
        return controller->button == platform::ControllerButton::cancel && controller->down;
    const auto* key = std::get_if<platform::KeyEvent>(&event);
    return key != nullptr && key->key == PlatformKey::escape && key->down && !key->repeated;
}

bool is_confirmation(const platform::InputEvent& event) {
    if (const auto* controller = std::get_if<platform::ControllerEvent>(&event))
        return controller->button == platform::ControllerButton::start && controller->down;
    const auto* key = std::get_if<platform::KeyEvent>(&event);
    return key != nullptr && key->key == PlatformKey::enter && key->down && !key->repeated;
}

void update_ui_input(ui::UiInput& input, std::span<const platform::InputEvent> events) {
    for (ui::UiButton& button : input.buttons) button.pressed = false;
    for (ui::UiButton& key : input.keys) key.pressed = false;
    input.wheel = {};
    input.text.clear();
    for (const platform::InputEvent& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event)) {
            update_key(input, *key);
        } else if (const auto* typed = std::get_if<platform::TextEvent>(&event)) {
            input.text += text::encode(std::u32string_view(&typed->character, 1));
        } else if (const auto* button = std::get_if<platform::ButtonEvent>(&event)) {
            update_button(input, *button);
        } else if (const auto* controller = std::get_if<platform::ControllerEvent>(&event)) {
            update_controller(input, *controller);
        } else if (const auto* cursor = std::get_if<platform::CursorEvent>(&event)) {
            input.pointer = cursor->at;
            input.pointer_inside = true;
        } else if (const auto* wheel = std::get_if<platform::WheelEvent>(&event)) {
            input.wheel += glm::vec2(wheel->notches);
        } else if (const auto* focus_event = std::get_if<platform::FocusEvent>(&event)) {
            if (focus_event->focused) continue;
            input.keys = {};
            for (ui::UiButton& held : input.buttons) held.down = false;
            input.ctrl = input.shift = input.alt = false;
        }
    }
}

using platform::Key;

namespace {

constexpr auto pause = static_cast<std::size_t>(Action::pause);

bool in_use(const KeyMap& keys, Key key) {
    return std::find(keys.keys.begin(), keys.keys.end(), key) != keys.keys.end();
}

}  // namespace

bool is_bindable(Key key) {
    switch (key) {
        case Key::unknown:
        case Key::escape:
        case Key::shift:
        case Key::control:
        case Key::alt:
        case Key::super:
            return false;
        default:
            return true;
    }
}

BindResult bind(KeyMap& keys, Action action, Key key) {
    if (!is_bindable(key)) return {BindOutcome::refused, action};
    Key& current = keys.keys.at(static_cast<std::size_t>(action));
    if (current == key) return {};
    const auto other = std::find(keys.keys.begin(), keys.keys.end(), key);
    if (other == keys.keys.end()) {
        current = key;
        return {};
    }
    if (current == Key::escape) return {BindOutcome::refused, static_cast<Action>(other - keys.keys.begin())};
    std::swap(current, *other);
    return {BindOutcome::swapped, static_cast<Action>(other - keys.keys.begin())};
}

std::map<std::string, std::string> names_of(const KeyMap& keys) {
    std::map<std::string, std::string> names;
    for (std::size_t i = 0; i < action_count; ++i)
        if (keys.keys.at(i) != Key::unknown)
            names[std::string(name(static_cast<Action>(i)))] = platform::name(keys.keys.at(i));
    return names;
}

KeyMap keys_of(const std::map<std::string, std::string>& names) {
    KeyMap keys;
    keys.keys.fill(Key::unknown);
    const KeyMap defaults;
    for (std::size_t i = 0; i < action_count; ++i)
        if (const auto found = names.find(std::string(name(static_cast<Action>(i)))); found != names.end())
            keys.keys.at(i) = platform::key_named(found->second);
    for (std::size_t i = 0; i < action_count; ++i)
        if (keys.keys.at(i) == Key::unknown && !in_use(keys, defaults.keys.at(i)))
            keys.keys.at(i) = defaults.keys.at(i);
    return keys;
}

content::SettingsVocabulary settings_vocabulary(std::vector<std::string> languages) {
    content::SettingsVocabulary vocabulary;
    vocabulary.languages = std::move(languages);
    for (std::size_t i = 0; i < action_count; ++i)
        vocabulary.actions.emplace_back(name(static_cast<Action>(i)));
    for (std::size_t i = 0; i < platform::key_count; ++i)
        if (const Key key = static_cast<Key>(i); is_bindable(key) || key == Key::escape)
            vocabulary.keys.emplace_back(platform::name(key));
    vocabulary.reserved.emplace(platform::name(Key::escape), name(static_cast<Action>(pause)));
    return vocabulary;
}

std::string key_name(const KeyMap& keys, Action action) {
    const Key key = keys.of(action);
    return key == Key::unknown ? "–" : std::string(platform::name(key));
}

}  // namespace bolt::trainer
