// What V does in the window (find_view.hpp), for simulated trainees.
#pragma once

#include "game/motion/view_help.hpp"

namespace bolt::view {

// Keeps what it has learnt of the shapes: one for each lesson.
motion::ViewHelp view_help();

}  // namespace bolt::view
