#include "game/trainer/key_binding.hpp"

#include <algorithm>

namespace bolt::trainer {

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
