#include "game/view/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bolt::view {

namespace {

constexpr double permitted = 0.9, comfortable = 0.75;  // of the period
constexpr int frames_to_lower = 2;
constexpr double time_to_raise = 1.0;  // s

double pixels(int step) {
    const auto side = static_cast<double>(resolution_steps[step]);
    return side * side;
}

}  // namespace

bool update(ResolutionControl& control, const FrameTime& frame) {
    const double gpu_time = frame.gpu, period = frame.period;
    if (!(gpu_time > 0.0) || !(period > 0.0)) return false;  // the GPU measures no times
    const int before = control.step;
    control.too_long = gpu_time > permitted * period ? control.too_long + 1 : 0;
    const bool could_raise =
        before > 0 && gpu_time * pixels(before - 1) / pixels(before) < comfortable * period;
    control.comfortable_for = could_raise ? control.comfortable_for + frame.elapsed : 0.0;
    if (control.too_long >= frames_to_lower) {
        // Skips to the step that should suffice, because each step on the way would cost missed frames.
        while (control.step < control.coarsest &&
               gpu_time * pixels(control.step) / pixels(before) > permitted * period)
            ++control.step;
    } else if (could_raise && control.comfortable_for >= time_to_raise) {
        --control.step;
    }
    if (control.step == before) return false;
    control.too_long = 0;
    control.comfortable_for = 0.0;
    return true;
}

VkExtent2D scaled(float share, VkExtent2D full) {
    const auto scale = [&](std::uint32_t pixels) {
        const float wanted = static_cast<float>(pixels) * share;
        return std::clamp<std::uint32_t>(2 * static_cast<std::uint32_t>(std::lround(0.5F * wanted)),
                                         std::min(2U, pixels), pixels);
    };
    return share == 1.0F ? full : VkExtent2D{scale(full.width), scale(full.height)};
}

render::Scene with_fewer_pixels(render::Scene scene, float share) {
    scene.outline_px *= share;
    for (render::Label& label : scene.labels) {
        label.offset_px *= share;
        if (label.placement == render::LabelPlacement::on_screen) label.height *= share;
    }
    return scene;
}

}  // namespace bolt::view
