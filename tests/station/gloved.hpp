// A hand for a station's tests, with a glove whose sensors are as easy as can be, at a bar across its palm.
#pragma once

#include <algorithm>
#include <cmath>

#include "haptics/station/hand.hpp"
#include "tests/grip/scene.hpp"

namespace bolt::test {

inline constexpr glove::Line sensor_line{0.0125, 40.0};

// What the glove gives while the hand is bent like this.
inline glove::BySensor<std::uint8_t> raw_of(const hand::Angles& a) {
    using glove::Sensor;
    glove::BySensor<double> angle{};
    const auto set = [&](Sensor sensor, double value) { angle[glove::index(sensor)] = value; };
    set(Sensor::thumb_roll, a.thumb.roll);
    set(Sensor::thumb_abduction, a.thumb.abduction);
    set(Sensor::thumb_mpj, a.thumb.mcp);
    set(Sensor::thumb_ij, a.thumb.ip);
    constexpr std::array<Sensor, 4> first{Sensor::index_mpj, Sensor::middle_mpj, Sensor::ring_mpj,
                                          Sensor::little_mpj};
    for (std::size_t i = 0; i < first.size(); ++i) {
        angle[glove::index(first[i])] = a.fingers[i].mcp;
        angle[glove::index(first[i]) + 1] = a.fingers[i].pip;
        angle[glove::index(first[i]) + 2] = a.fingers[i].dip;
    }
    set(Sensor::palm_arch, a.arch);
    glove::BySensor<std::uint8_t> raw{};
    for (std::size_t i = 0; i < raw.size(); ++i)
        raw[i] = static_cast<std::uint8_t>(
            std::clamp(std::lround(angle[i] / sensor_line.gain + sensor_line.offset), 1L, 255L));
    return raw;
}

inline glove::BySensor<std::uint8_t> raw_open() { return raw_of(grip_test::closed(0.0)); }
inline glove::BySensor<std::uint8_t> raw_closed() { return raw_of(grip_test::closed(1.0)); }

inline station::HandPlan hand_at_bar() {
    glove::Wearer wearer;
    wearer.calibration.lines.fill(sensor_line);
    wearer.hand = hand::make_hand(hand::Side::right);
    return {wearer, grip_test::bar().tool, grip_test::across_the_palm(), {}};
}

}  // namespace bolt::test
