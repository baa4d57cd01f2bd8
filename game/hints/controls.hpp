// What is pressed or moved for each motion that a hint asks for, in somebody's language. Keys and buttons are
// named by who has bound them.
#pragma once

#include "game/hints/hint.hpp"

namespace bolt::hints {

// With a mouse: press on a nut and hold, drag, let go. `tool_key` takes the wrench and lays it down.
Controls mouse_controls(const words::Words& words, const std::string& tool_key);

// With a device in the hand: `button` closes the hand, `tool_key` lays the wrench down.
Controls device_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// With what is only pushed, and feels nothing: while `button` is held it goes the last bit by itself.
Controls puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key);
Controls keyboard_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// With a hand in a glove: it moves as it would without, and does the rest with its fingers.
Controls glove_controls(const words::Words& words, Controls moved_by);

}  // namespace bolt::hints
