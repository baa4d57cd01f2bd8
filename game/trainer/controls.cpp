#include "game/trainer/controls.hpp"

#include <algorithm>
#include <optional>

#include "engine/text/layout.hpp"

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

using platform::Key;

namespace {

constexpr auto pause = static_cast<std::size_t>(Action::pause);

bool taken(const KeyMap& keys, Key key) {
    return std::find(keys.keys.begin(), keys.keys.end(), key) != keys.keys.end();
}

}  // namespace

bool can_be_bound(Key key) {
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

Binding bind(KeyMap& keys, Action action, Key key) {
    if (!can_be_bound(key)) return {Bound::refused, action};
    Key& mine = keys.keys.at(static_cast<std::size_t>(action));
    if (mine == key) return {};
    const auto other = std::find(keys.keys.begin(), keys.keys.end(), key);
    if (other == keys.keys.end()) {
        mine = key;
        return {};
    }
    if (mine == Key::escape) return {Bound::refused, static_cast<Action>(other - keys.keys.begin())};
    std::swap(mine, *other);
    return {Bound::swapped, static_cast<Action>(other - keys.keys.begin())};
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
    const KeyMap usual;
    for (std::size_t i = 0; i < action_count; ++i)
        if (const auto named = names.find(std::string(name(static_cast<Action>(i)))); named != names.end())
            keys.keys.at(i) = platform::key_named(named->second);
    for (std::size_t i = 0; i < action_count; ++i)
        if (keys.keys.at(i) == Key::unknown && !taken(keys, usual.keys.at(i)))
            keys.keys.at(i) = usual.keys.at(i);
    return keys;
}

content::SettingsVocabulary settings_vocabulary(std::vector<std::string> languages) {
    content::SettingsVocabulary known;
    known.languages = std::move(languages);
    for (std::size_t i = 0; i < action_count; ++i) known.actions.emplace_back(name(static_cast<Action>(i)));
    for (std::size_t i = 0; i < platform::key_count; ++i)
        if (const Key key = static_cast<Key>(i); can_be_bound(key) || key == Key::escape)
            known.keys.emplace_back(platform::name(key));
    known.reserved.emplace(platform::name(Key::escape), name(static_cast<Action>(pause)));
    return known;
}

std::string key_name(const KeyMap& keys, Action action) {
    const Key key = keys.of(action);
    return key == Key::unknown ? "–" : std::string(platform::name(key));
}

}  // namespace bolt::trainer
