#include "haptics/glove/gloved_hand.hpp"

#include <algorithm>

#include "haptics/hand/limits.hpp"

namespace bolt::glove {

void take(GlovedHand& state, const Wearer& wearer, const Frame& frame, double time) {
    const double gap = std::max(time - state.time, least_gap);
    if (!state.any || gap > wearer.longest_gap) state.filters = {};
    BySensor<double> angles = sensor_angles(wearer.calibration, frame);
    for (std::size_t i = 0; i < all_sensors; ++i)
        angles[i] = filtered(state.filters[i], wearer.filter, angles[i], gap);
    state.angles = hand::limited(hand_angles(angles));
    state.time = std::max(state.time, time);
    state.any = true;
}

}  // namespace bolt::glove
