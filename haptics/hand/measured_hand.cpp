#include "haptics/hand/measured_hand.hpp"

#include <algorithm>

#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {
namespace {

// MPJ, PIJ and DIJ of the fingers, index to little.
constexpr std::array<std::array<Sensor, 3>, 4> fingers{
    {{Sensor::index_mpj, Sensor::index_pij, Sensor::index_dij},
     {Sensor::middle_mpj, Sensor::middle_pij, Sensor::middle_dij},
     {Sensor::ring_mpj, Sensor::ring_pij, Sensor::ring_dij},
     {Sensor::little_mpj, Sensor::little_pij, Sensor::little_dij}}};

}  // namespace

PerSensor<double> sensor_angles(const Calibration& calibration, const GloveFrame& frame) {
    PerSensor<double> angles{};
    PerSensor<bool> measured{};
    for (std::size_t i = 0; i < sensor_count; ++i) {
        measured[i] = calibration.fits[i].has_value() && frame.raw[i] != 0;
        if (measured[i]) angles[i] = angle(*calibration.fits[i], frame.raw[i]);
    }
    for (const auto& [mpj, pij, dij] : fingers)
        if (!measured[index(dij)]) angles[index(dij)] = dip_of_pip * angles[index(pij)];
    return angles;
}

hand::Angles hand_angles(const PerSensor<double>& angles) {
    const auto of = [&](Sensor sensor) { return angles[index(sensor)]; };
    hand::Angles hand;
    hand.thumb = {of(Sensor::thumb_roll), of(Sensor::thumb_abduction), of(Sensor::thumb_mpj),
                  of(Sensor::thumb_ij)};
    const double ring = of(Sensor::ring_abduction);
    const std::array<double, 4> abduction{of(Sensor::middle_abduction), 0.0, ring,
                                          ring + of(Sensor::little_abduction)};
    for (std::size_t i = 0; i < fingers.size(); ++i)
        hand.fingers[i] = {of(fingers[i][0]), of(fingers[i][1]), of(fingers[i][2]), abduction[i]};
    hand.arch = of(Sensor::palm_arch);
    hand.wrist_flexion = of(Sensor::wrist_pitch);
    hand.wrist_deviation = of(Sensor::wrist_yaw);
    return hand;
}

void update(MeasuredHand& state, const GloveWearer& wearer, const GloveFrame& frame, double time) {
    const double gap = std::max(time - state.time, min_gap);
    if (!state.has_frame || gap > wearer.max_gap) state.filters = {};
    PerSensor<double> angles = sensor_angles(wearer.calibration, frame);
    for (std::size_t i = 0; i < sensor_count; ++i)
        angles[i] = filtered(state.filters[i], wearer.filter, angles[i], gap);
    state.angles = hand::clamp_to_limits(hand_angles(angles));
    state.time = std::max(state.time, time);
    state.has_frame = true;
}

}  // namespace bolt::hand
