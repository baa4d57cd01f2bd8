// What people do to the window, for the interface.
#pragma once

#include <span>

#include "engine/platform/input.hpp"
#include "engine/ui/input.hpp"

namespace bolt::trainer {

// Into `input`, which keeps from frame to frame what is held down. Size, scale and time are the caller's.
void feed(ui::Input& input, std::span<const platform::Event> events);

}  // namespace bolt::trainer
