// The trainer in a window of the desktop.
#pragma once

#include "engine/platform/window.hpp"
#include "game/trainer/app.hpp"

namespace bolt::trainer {

struct WindowChoice {
    std::string gpu;             // part of the name of the GPU to use; empty: the best
    std::function<bool()> stop;  // asked every frame: somebody wants the program to end
};

// Until it is closed; a lesson under way is then ended as it stands. A GPU that is lost is started again,
// once in a while (gpu::DeviceLossPolicy); the lesson goes on.
Status run_in_window(App& app, platform::Window& window, const gpu::Instance& instance,
                     const WindowChoice& choice = {});

}  // namespace bolt::trainer
