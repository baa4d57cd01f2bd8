// The trainee's hand as measured by the glove: glove frames in, filtered and clamped joint angles out. Pure;
// allocates nothing.
#pragma once

#include "engine/base/math.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_protocol.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {

// The 1€ filter: a low-pass whose corner frequency rises with speed, which reduces noise at rest and lag in
// motion. Source: G. Casiez, N. Roussel, D. Vogel, 1€ filter: a simple speed-based low-pass filter for noisy
// input in interactive systems, CHI 2012. At constant speed v the lag is below 1/(2π (rest_cutoff +
// cutoff_per_speed |v|)) s: with these values 9.6 ms at 1 rad/s, a slow deliberate motion. At 1 rad/s and 80
// frames a second the lag is 6.5 ms, because the filter measures the speed from its own lagging value and so
// overestimates it.
struct OneEuroOptions {
    double rest_cutoff = 1.5;        // Hz, corner frequency at rest
    double cutoff_per_speed = 15.0;  // Hz per rad/s
    double speed_cutoff = 3.0;       // Hz, corner frequency of the speed filter
};

struct OneEuro {
    double value = 0.0, speed = 0.0;
    bool started = false;
};

// Smoothing factor of a first-order low-pass with this corner frequency (Hz) and time step dt (s).
inline double smoothing_factor(double corner, double dt) {
    return 1.0 / (1.0 + 1.0 / (2.0 * pi * corner * dt));
}

// Filters the value measured `dt` seconds (> 0) after the last one.
inline double filtered(OneEuro& filter, const OneEuroOptions& options, double value, double dt) {
    if (!filter.started) {
        filter = {value, 0.0, true};
        return value;
    }
    const double speed = (value - filter.value) / dt;
    filter.speed += smoothing_factor(options.speed_cutoff, dt) * (speed - filter.speed);
    const double corner = options.rest_cutoff + options.cutoff_per_speed * std::abs(filter.speed);
    filter.value += smoothing_factor(corner, dt) * (value - filter.value);
    return filter.value;
}

// Angle of each sensor's joint, rad, signs as in glove_calibration.hpp. The outer joint of a finger
// (DIJ), if it has no sensor, follows the middle joint (PIJ). Other joints without a calibrated sensor are 0,
// for example the wrist after a calibration by postures.
PerSensor<double> sensor_angles(const Calibration& calibration, const GloveFrame& frame);

// Ratio of the flexion of a finger's outer joint (DIP) to that of its middle joint (PIP) (H. Rijpkema, M.
// Girard, Computer animation of knowledge-based human grasping, SIGGRAPH 1991).
inline constexpr double dip_of_pip = 2.0 / 3.0;

// Abduction sensors measure the angle between neighbouring fingers. They are summed outward from the middle
// finger, whose own abduction is not measured and is taken as 0.
hand::Angles hand_angles(const PerSensor<double>& angles);

struct GloveWearer {
    Calibration calibration;
    hand::Hand hand;  // its side is the glove's
    OneEuroOptions filter;
    double max_gap = 0.25;  // s between frames; after a longer gap the filters restart
};

struct MeasuredHand {
    PerSensor<OneEuro> filters{};
    hand::Angles angles;     // filtered and clamped
    double time = 0.0;       // s, time of the last frame
    bool has_frame = false;  // a frame has been received
};

inline constexpr double min_gap = 1e-3;  // s; a smaller gap between frames counts as this gap

// `time`: when the frame was read, s on a monotonic clock.
void update(MeasuredHand& state, const GloveWearer& wearer, const GloveFrame& frame, double time);

}  // namespace bolt::hand
