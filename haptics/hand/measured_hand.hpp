// The trainee's hand as measured by the glove: frames in, filtered and clamped angles out. Pure; allocates
// nothing.
#pragma once

#include "haptics/hand/hand_angles.hpp"
#include "haptics/hand/one_euro.hpp"

namespace bolt::hand {

struct GloveWearer {
    Calibration calibration;
    hand::Hand hand;  // its side is the glove's
    OneEuroOptions filter;
    double longest_gap = 0.25;  // s between frames; after a longer gap the filters restart
};

struct MeasuredHand {
    PerSensor<OneEuro> filters{};
    hand::Angles angles;  // filtered and clamped
    double time = 0.0;    // s, time of the last frame
    bool any = false;     // a frame has been received
};

// `time`: when the frame was read, s on a monotonic clock. Frames closer than `least_gap` count as that far
// apart.
inline constexpr double least_gap = 1e-3;  // s
void update(MeasuredHand& state, const GloveWearer& wearer, const GloveFrame& frame, double time);

}  // namespace bolt::hand
