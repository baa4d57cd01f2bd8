// The program's help with the view for a simulated trainee: returns an eye from which the nut is visible.
#pragma once

#include <functional>

#include "haptics/servo/setup.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::motion {

struct ViewAsk {
    const servo::Setup& setup;
    const servo::ToolContact& touch;
    std::size_t joint = 0;
    Vec3 nut{0.0};  // m, its middle
    Pose wrench;    // where it is going to be
    Vec3 eye{0.0};  // m, where it is now
};

using ViewHelp = std::function<Vec3(const ViewAsk&)>;  // m, the eye in the new view

}  // namespace bolt::motion
