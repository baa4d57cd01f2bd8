// A hand for tests of a station: its glove's sensors all have the same fit, and a bar lies across its palm.
#pragma once

#include "haptics/station/gloved_hand.hpp"
#include "tests/hand/test_tools.hpp"
#include "tools/emulate/glove.hpp"

namespace bolt::test {

inline constexpr hand::LinearFit sensor_line{0.0125, 40.0};

inline hand::PerSensor<std::uint8_t> raw_open() {
    return emulate::raw_values(grasp_test::closed(0.0), sensor_line);
}
inline hand::PerSensor<std::uint8_t> raw_closed() {
    return emulate::raw_values(grasp_test::closed(1.0), sensor_line);
}

inline station::HandSetup hand_at_bar() {
    hand::GloveWearer wearer;
    wearer.calibration.fits.fill(sensor_line);
    wearer.hand = hand::make_hand(hand::Side::right);
    return {wearer, grasp_test::bar().tool, grasp_test::across_the_palm(), {}};
}

}  // namespace bolt::test
