// A hand for a station's tests, with a glove whose sensors are as easy as can be, at a bar across its palm.
#pragma once

#include "haptics/station/hand.hpp"
#include "tests/grip/scene.hpp"
#include "tools/emulate/glove.hpp"

namespace bolt::test {

inline constexpr glove::Line sensor_line{0.0125, 40.0};

inline glove::BySensor<std::uint8_t> raw_open() {
    return emulate::raw_at(grip_test::closed(0.0), sensor_line);
}
inline glove::BySensor<std::uint8_t> raw_closed() {
    return emulate::raw_at(grip_test::closed(1.0), sensor_line);
}

inline station::HandPlan hand_at_bar() {
    glove::Wearer wearer;
    wearer.calibration.lines.fill(sensor_line);
    wearer.hand = hand::make_hand(hand::Side::right);
    return {wearer, grip_test::bar().tool, grip_test::across_the_palm(), {}};
}

}  // namespace bolt::test
