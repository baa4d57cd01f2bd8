// Describes, in the trainee's language, which input performs each motion of a hint. The caller names the
// bound keys and buttons.
#pragma once

#include "game/lesson/hint.hpp"

namespace bolt::lesson {

// Mouse: press on a nut and hold, drag, release. `tool_key` takes the wrench and puts it down.
Controls mouse_controls(const words::Words& words, const std::string& tool_key);

// Force-feedback device: `button` closes the hand, `tool_key` puts the wrench down.
Controls device_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// Devices without force feedback: while `button` is held, the tool covers the last distance by itself.
Controls puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key);
Controls keyboard_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// Glove: `moved_by` moves the hand; the fingers do the rest.
Controls glove_controls(const words::Words& words, Controls moved_by);

}  // namespace bolt::lesson
