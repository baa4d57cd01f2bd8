// What V does in the window (find_view.hpp), for simulated trainees.
#pragma once

#include "game/operators/view_help.hpp"

namespace bolt::scene {

// Keeps what it has learnt of the shapes: one for each lesson.
operators::ViewHelp view_help();

}  // namespace bolt::scene
