// Input of the trainer: key bindings, and window events as input for a lesson and for the interface.
//
// Mouse in a lesson with the helped hand: the left button on a nut or the wrench moves the hand; elsewhere it
// turns the view, as the right button does. The middle button pans, the mouse wheel zooms. Escape always
// pauses, whatever the key map says. A game controller moves through the menus and pauses a lesson; it does
// not move the hand.
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
    tool,        // takes the wrench or lays it down
    find_view,   // shows the due joint
    whole_view,  // shows the whole workpiece
    hint,        // requests a hint
    clamp_map,   // shows and hides the clamp force of every joint
    pause,
    full_screen,
    mute,           // mutes and unmutes the sound
    undo,           // returns to the previous step
    restart_step,   // begins the due step again
    recentre,       // at a station: moves the tool to its initial pose
    close_up,       // shows and hides the close-up
    second_wrench,  // puts the second wrench on the held or due joint, or takes it away
    place_again,    // in a room: places panel and workpiece in front of the user
    turn_left,      // in a room: this and the next three move the workpiece by a step
    turn_right,
    raise,
    lower,
    mirror,  // with a headset: the window shows the next picture, such as both eyes (view::Mirror)
};
inline constexpr std::size_t action_count = static_cast<std::size_t>(Action::mirror) + 1;  // the last one

// The name of the action in settings files. They keep older names for clamp_map and mute.
constexpr std::string_view name(Action action) {
    constexpr std::array names = std::to_array<std::string_view>(
        {"tool", "find_view", "whole_view", "hint", "flange_map", "pause", "full_screen", "quiet", "undo",
         "restart_step", "recentre", "close_up", "second_wrench", "place_again", "turn_left", "turn_right",
         "raise", "lower", "mirror"});
    static_assert(names.size() == action_count);
    return names.at(static_cast<std::size_t>(action));
}

// In the order of Action.
inline constexpr std::array default_keys = std::to_array<platform::Key>(
    {platform::Key::t, platform::Key::v, platform::Key::f, platform::Key::h, platform::Key::c,
     platform::Key::escape, platform::Key::f11, platform::Key::m, platform::Key::backspace, platform::Key::r,
     platform::Key::home, platform::Key::i, platform::Key::g, platform::Key::b, platform::Key::j,
     platform::Key::l, platform::Key::plus, platform::Key::minus, platform::Key::f9});
static_assert(default_keys.size() == action_count);

struct KeyMap {
    std::array<platform::Key, action_count> keys = default_keys;
    [[nodiscard]] platform::Key of(Action action) const { return keys.at(static_cast<std::size_t>(action)); }
};

// Input of one frame. Positions and movements in pixels, origin at the upper left corner of the picture.
struct FrameInput {
    std::array<bool, action_count> actions{};
    [[nodiscard]] bool triggered(Action action) const { return actions.at(static_cast<std::size_t>(action)); }
    std::optional<glm::dvec2> pressed_at;  // where the left button was pressed in this frame
    bool left_down = false;
    bool close_requested = false;
    glm::dvec2 pointer{0.0};
    glm::dvec2 left_drag{0.0}, right_drag{0.0}, middle_drag{0.0};
    glm::dvec2 turn_drag{0.0};  // the part of left_drag with the right button held too
    double scroll = 0.0;        // notches of the mouse wheel
};

// Kept from frame to frame.
struct InputState {
    KeyMap keys;
    glm::dvec2 pointer{0.0};
    bool left = false, middle = false, right = false;  // buttons held
};

// True for each input that belongs to the lesson, not to a menu.
struct InputFocus {
    bool pointer = true, keys = true;
};

// Updates the state with the events of a frame and returns the lesson's input.
FrameInput apply_events(InputState& state, std::span<const platform::InputEvent> events,
                        const InputFocus& focus);

// Updates the interface's input with the events of a frame, except size, scale and time.
void update_ui_input(ui::UiInput& input, std::span<const platform::InputEvent> events);

// True for Escape and the controller's cancel button, which close a page or the settings.
bool is_back(const platform::InputEvent& event);
// True for Enter and the controller's start button, which do what the first button of a screen does.
bool is_confirmation(const platform::InputEvent& event);

// False for modifiers, and for Escape, which always pauses a lesson or closes a page.
bool is_bindable(platform::Key key);

enum class BindOutcome : std::uint8_t { done, swapped, refused };
struct BindResult {
    BindOutcome outcome = BindOutcome::done;
    Action other = Action::tool;  // swapped: the action that had the new key and now has the old one
};

// Binds `key` to `action`. If another action has the key, the two actions swap keys. Refuses, without a
// change, a key that is not bindable and a swap that would give Escape to another action.
BindResult bind(KeyMap& keys, Action action, platform::Key key);

// Conversion to and from the names in a settings file. An action that is missing there gets its default key,
// or none if another action has that key.
std::map<std::string, std::string> names_of(const KeyMap& keys);
KeyMap keys_of(const std::map<std::string, std::string>& names);

// The values that a settings file may contain.
content::SettingsVocabulary settings_vocabulary(std::vector<std::string> languages);

// "T"; "–" for an action without a key.
std::string key_name(const KeyMap& keys, Action action);

}  // namespace bolt::trainer
