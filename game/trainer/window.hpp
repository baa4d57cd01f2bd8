// Runs the trainer in a desktop window.
#pragma once

#include "engine/platform/window.hpp"
#include "game/trainer/app.hpp"

namespace bolt::trainer {

struct WindowChoice {
    std::string gpu;             // part of the name of the GPU to use; empty: the best
    std::function<bool()> stop;  // polled every frame; true closes the window
};

// Returns when the window is closed; a lesson that still runs is ended as it stands. A lost GPU is started
// again and the lesson continues, unless it was lost shortly before (gpu::DeviceLossPolicy).
Status run_in_window(App& app, platform::Window& window, const gpu::Instance& instance,
                     const WindowChoice& choice = {});

}  // namespace bolt::trainer
