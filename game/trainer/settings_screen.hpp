// The screen with a trainee's settings and keys, opened from the menu and from the pause. Changes apply at
// once; working hand, seat height and force scale apply from the next lesson on.
#pragma once

#include "game/trainer/screens.hpp"

namespace bolt::trainer {

class SettingsScreen {
  public:
    // Where the settings were opened. `lesson`: adds the note about changes that wait for the next lesson;
    // `study`: leaves out the strength of forces, which must not change between the conditions of a study.
    // `room`: adds the keys of a room.
    struct OpenedIn {
        bool lesson = false, study = false, room = false;
    };
    // Returns close_settings or none.
    ScreenAction draw(const ScreenContext& context, Preferences& preferences, OpenedIn opened_in);

    // Handles the keys of a frame and returns the events that remain for the interface. After a click on an
    // action the next key is bound to it; Escape cancels that, or closes the screen and sets `closes`.
    std::vector<platform::InputEvent> take_keys(std::span<const platform::InputEvent> events,
                                                const words::Words& words, KeyMap& keys, bool& closes);

  private:
    void draw_person(const ScreenContext& context, content::TraineeSettings& settings, bool in_study);
    void draw_keys(const ScreenContext& context, KeyMap& keys, bool in_room);
    void bind_key(platform::Key key, const words::Words& words, KeyMap& keys);

    std::optional<Action> waiting_;  // the action to which the next key is bound
    std::string message_;            // about the last key that was pressed
};

}  // namespace bolt::trainer
