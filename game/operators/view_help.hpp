// The program's help with the view, as a simulated trainee has it: asked for, it puts the eye where a place
// is well seen.
#pragma once

#include <functional>

#include "haptics/servo/setup.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::operators {

struct ViewAsk {
    const servo::Setup& setup;
    const servo::Touch& touch;
    std::size_t joint = 0;
    Vec3 nut{0.0};  // m, its middle
    Pose wrench;    // where it is going to be
    Vec3 eye{0.0};  // m, where it is now
};

using ViewHelp = std::function<Vec3(const ViewAsk&)>;  // m, the eye in the new view

}  // namespace bolt::operators
