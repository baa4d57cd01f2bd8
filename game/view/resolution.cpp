#include "game/view/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bolt::view {

namespace {

constexpr double permitted = 0.9, comfortable = 0.75;  // of the period
constexpr int frames_to_lower = 2;
constexpr double time_to_raise = 1.0;  // s
constexpr int last_step = static_cast<int>(std::size(resolution_steps)) - 1;

double pixels(int step) {
    const auto share = static_cast<double>(resolution_steps[step]);
    return share * share;
}

}  // namespace

bool update(ResolutionControl& control, double gpu_time, double period) {
    if (!(gpu_time > 0.0) || !(period > 0.0)) return false;  // the GPU measures no times
    const int before = control.step;
    control.too_long = gpu_time > permitted * period ? control.too_long + 1 : 0;
    const bool could_raise =
        before > 0 && gpu_time * pixels(before - 1) / pixels(before) < comfortable * period;
    control.short_enough = could_raise ? control.short_enough + 1 : 0;
    if (control.too_long >= frames_to_lower) {
        // At once to the step that should suffice: every step on the way would cost missed frames.
        while (control.step < last_step &&
               gpu_time * pixels(control.step) / pixels(before) > permitted * period)
            ++control.step;
    } else if (control.short_enough * period >= time_to_raise) {
        --control.step;
    }
    if (control.step == before) return false;
    control.too_long = control.short_enough = 0;
    return true;
}

VkExtent2D scaled(const ResolutionControl& control, VkExtent2D full) {
    const auto scale = [&](std::uint32_t pixels) {
        const float wanted = static_cast<float>(pixels) * resolution_steps[control.step];
        return std::clamp<std::uint32_t>(2 * static_cast<std::uint32_t>(std::lround(0.5F * wanted)), 2,
                                         pixels);
    };
    return control.step == 0 ? full : VkExtent2D{scale(full.width), scale(full.height)};
}

}  // namespace bolt::view
