// The resolution at which the GPU keeps the frame rate of a display. Fewer pixels are better than missed
// frames: a headset that misses a frame shows the last one again, and the world seems to jerk; in a window
// the lesson falls behind real time.
#pragma once

#include <iterator>

#include "engine/gpu/vk.hpp"
#include "engine/render/scene.hpp"

namespace bolt::view {

// Fractions of the full width and height. The steps are few, because each change makes new render targets.
inline constexpr float resolution_steps[] = {1.0F, 0.85F, 0.72F, 0.6F, 0.5F, 0.42F, 0.35F};

struct ResolutionControl {
    int coarsest = static_cast<int>(std::size(resolution_steps)) - 1;  // index of the lowest permitted step
    int step = 0;                                                      // index of resolution_steps
    int too_long = 0;              // frames in a row that took longer than permitted
    double comfortable_for = 0.0;  // s for which the next higher resolution would be possible too
};

struct FrameTime {
    double gpu = 0.0;      // s, that the GPU took for a frame at the present resolution; 0: unknown
    double period = 0.0;   // s, that a frame may take; 0: the resolution stays
    double elapsed = 0.0;  // s, since the last frame
};

// Call once a frame. Lowers the resolution at the second frame in a row that takes more than 90 % of the
// period. Raises it by a step if a frame with the pixels of the higher step would have taken less than 75 %
// of the period, for a second (its time is estimated in proportion to its pixels). Returns true if the
// resolution changed; then ignore the times of frames that were already drawn.
bool update(ResolutionControl& control, const FrameTime& frame);

// The fraction of the full width and height.
inline float share_of(const ResolutionControl& control) { return resolution_steps[control.step]; }

// The size of a picture whose full size is `full`: even numbers of pixels, unless `share` is 1.
VkExtent2D scaled(float share, VkExtent2D full);

// The scene for a picture that has this share of the window's width and height: lengths in pixels are scaled.
render::Scene with_fewer_pixels(render::Scene scene, float share);

}  // namespace bolt::view
