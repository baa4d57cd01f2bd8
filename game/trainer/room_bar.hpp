// The buttons on the panel of a lesson in a room, for hands without buttons of their own, and the line about
// the buttons of the controllers.
#pragma once

#include "engine/xr/input.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

struct RoomBar {
    words::TextKey controls = "room.controls.hands";  // the line about the buttons, from controls_text()
    bool moves_workpiece = true;                      // the workpiece can be turned and raised
    bool second_wrench = false;                       // the lesson needs one
};

// The text about the buttons of the controller in a hand. `controller`: null for a bare hand or an unknown
// controller.
words::TextKey controls_text(const xr::ControllerProfile* controller);

// Returns the action of the button that was pressed.
ScreenAction draw_room_bar(const ScreenContext& context, const RoomBar& bar);

}  // namespace bolt::trainer
