// A trainee's hand as the glove measures it: frames in, angles out, filtered and within what a hand can do.
// Pure, allocates nothing.
#pragma once

#include "haptics/glove/hand_angles.hpp"
#include "haptics/glove/one_euro.hpp"

namespace bolt::glove {

struct Wearer {
    Calibration calibration;
    hand::Hand hand;  // its side is that of the glove
    OneEuroOptions filter;
    double longest_gap = 0.25;  // s between frames: after more, the filters begin anew
};

struct GlovedHand {
    BySensor<OneEuro> filters{};
    hand::Angles angles;  // filtered, limited
    double time = 0.0;    // s, of the last frame
    bool any = false;     // a frame came
};

// A frame and when it was read (s, of a clock that goes on). One that is not later than the last counts as
// read this much after it.
inline constexpr double least_gap = 1e-3;  // s
void take(GlovedHand& state, const Wearer& wearer, const Frame& frame, double time);

}  // namespace bolt::glove
