#include "haptics/hand/measured_hand.hpp"

#include <algorithm>

#include "haptics/hand/limits.hpp"

namespace bolt::hand {

void update(MeasuredHand& state, const GloveWearer& wearer, const GloveFrame& frame, double time) {
    const double gap = std::max(time - state.time, least_gap);
    if (!state.any || gap > wearer.longest_gap) state.filters = {};
    PerSensor<double> angles = sensor_angles(wearer.calibration, frame);
    for (std::size_t i = 0; i < sensor_count; ++i)
        angles[i] = filtered(state.filters[i], wearer.filter, angles[i], gap);
    state.angles = hand::clamp_to_limits(hand_angles(angles));
    state.time = std::max(state.time, time);
    state.any = true;
}

}  // namespace bolt::hand
