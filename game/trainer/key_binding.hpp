// Which key does what, as a trainee has it: bound by pressing one, kept by names.
#pragma once

#include <map>
#include <string>

#include "content/trainee/settings.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::trainer {

// Not modifiers, and not Escape: that always pauses a lesson and leaves a menu.
bool can_be_bound(platform::Key key);

enum class Bound : std::uint8_t { done, swapped, refused };
struct Binding {
    Bound how = Bound::done;
    Action with = Action::tool;  // swapped: whose key it was, and who has the other one now
};

// A key that another action has is swapped for the one that this action had; refused, and nothing changed, is
// one that cannot be bound, and a swap that would give Escape away.
Binding bind(KeyMap& keys, Action action, platform::Key key);

// What a file keeps, and back: an action that it does not name has its usual key, or none if that is taken.
std::map<std::string, std::string> names_of(const KeyMap& keys);
KeyMap keys_of(const std::map<std::string, std::string>& names);

// What may stand in a file of settings.
content::SettingsVocabulary settings_vocabulary(std::vector<std::string> languages);

// "T"; "–" for an action without a key.
std::string key_name(const KeyMap& keys, Action action);

}  // namespace bolt::trainer
