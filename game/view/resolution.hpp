// The resolution at which the GPU keeps the frame rate of a display. Fewer pixels are better than missed
// frames: a headset that misses a frame shows the last one again, and the world seems to jerk.
#pragma once

#include "engine/gpu/vk.hpp"

namespace bolt::view {

// Fractions of the full width and height. The steps are few, because each change makes new render targets.
inline constexpr float resolution_steps[] = {1.0F, 0.85F, 0.72F, 0.6F, 0.5F, 0.42F, 0.35F};

struct ResolutionControl {
    int step = 0;          // index of resolution_steps
    int too_long = 0;      // frames in a row that took longer than permitted
    int short_enough = 0;  // frames in a row after which the next larger resolution would also be possible
};

// Call once a frame. `gpu_time`: s, that the GPU took for a frame at the present resolution; `period`: s, of
// the display. Lowers the resolution at the second frame in a row that takes more than 90 % of the period,
// and raises it only if for a second the cost at the higher one, which grows with the number of pixels, would
// have been below 75 %. Returns true if the resolution changed; then ignore the times of frames that were
// already drawn.
bool update(ResolutionControl& control, double gpu_time, double period);

// The size of a picture whose full size is `full`: even numbers of pixels.
VkExtent2D scaled(const ResolutionControl& control, VkExtent2D full);

}  // namespace bolt::view
