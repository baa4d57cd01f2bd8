// What people mean by keys and mouse in a lesson. Keys are a table that can be another one (key_binding.hpp);
// Escape pauses whatever that says, so that nobody is shut in. The mouse is:
// left on a nut or the wrench the hand, left elsewhere or right the view, middle moves it, the wheel comes
// nearer.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "content/trainee/settings.hpp"
#include "engine/platform/input.hpp"
#include "engine/ui/input.hpp"

namespace bolt::trainer {

enum class Action : std::uint8_t {
    tool,       // take the wrench, or lay it down
    find_view,  // look at what is due
    whole_view,
    hint,
    flange_map,
    pause,
    full_screen,
    quiet,  // sound off and on
    undo,   // the step before is due again
    restart_step,
    recentre,  // at a station: the tool goes back to where it was at the beginning
    close_up,  // the picture from the wrench on and off
};
inline constexpr std::size_t action_count = 12;
constexpr std::string_view name(Action action) {
    constexpr std::array<std::string_view, action_count> names{
        "tool",        "find_view", "whole_view", "hint",         "flange_map", "pause",
        "full_screen", "quiet",     "undo",       "restart_step", "recentre",   "close_up"};
    return names.at(static_cast<std::size_t>(action));
}

struct KeyMap {
    std::array<platform::Key, action_count> keys{
        platform::Key::t,         platform::Key::v,      platform::Key::f,    platform::Key::h,
        platform::Key::c,         platform::Key::escape, platform::Key::f11,  platform::Key::m,
        platform::Key::backspace, platform::Key::r,      platform::Key::home, platform::Key::i};
    [[nodiscard]] platform::Key of(Action action) const { return keys.at(static_cast<std::size_t>(action)); }
};

// Of a frame. Pixels from the upper left corner of the picture.
struct Wanted {
    std::array<bool, action_count> actions{};
    [[nodiscard]] bool wants(Action action) const { return actions.at(static_cast<std::size_t>(action)); }
    std::optional<glm::dvec2> pressed;  // the left button went down here
    bool left = false;                  // it is down
    bool close = false;
    glm::dvec2 pointer{0.0};
    glm::dvec2 dragged{0.0};             // with the left button down
    glm::dvec2 turned{0.0}, moved{0.0};  // with the right, with the middle one
    double wheel = 0.0;
};

struct Controls {
    KeyMap keys;
    glm::dvec2 pointer{0.0};
    bool left = false, middle = false, right = false;
};

// `mine`: whether pointer and keys are the lesson's now, and not the menu's.
struct Mine {
    bool pointer = true, keys = true;
};
Wanted apply(Controls& controls, std::span<const platform::Event> events, const Mine& mine);

// What people do to the window, for the interface.

// Into `input`, which keeps from frame to frame what is held down. Size, scale and time are the caller's.
void feed(ui::Input& input, std::span<const platform::Event> events);

// Which key does what, as a trainee has it: bound by pressing one, kept by names.

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
