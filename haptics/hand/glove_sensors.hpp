// The bend sensors of a CyberGlove and their order in the samples of a glove with 18 or 22 sensors. Source:
// Kessler, Hodges and Walker, "Evaluation of the CyberGlove as a whole-hand input device", ACM TOCHI 2(4),
// 1995.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace bolt::hand {

// In the order of a glove with 22 sensors. MPJ: knuckle; PIJ, DIJ: the next joints; IJ: the thumb's last
// joint.
enum class Sensor : std::uint8_t {
    thumb_roll,  // rotation of the thumb across the palm
    thumb_mpj,
    thumb_ij,
    thumb_abduction,  // thumb to index
    index_mpj,
    index_pij,
    index_dij,
    middle_mpj,
    middle_pij,
    middle_dij,
    middle_abduction,  // index to middle
    ring_mpj,
    ring_pij,
    ring_dij,
    ring_abduction,  // middle to ring
    little_mpj,
    little_pij,
    little_dij,
    little_abduction,  // ring to little
    palm_arch,
    wrist_pitch,
    wrist_yaw,
};
inline constexpr std::size_t sensor_count = 22;

// One value per Sensor.
template <class T>
using PerSensor = std::array<T, sensor_count>;

constexpr std::size_t index(Sensor sensor) { return static_cast<std::size_t>(sensor); }

// The sensors of a glove with `count` sensors, in the order of its samples; empty unless `count` is 18 or 22.
// A glove with 18 lacks the four DIJ.
std::span<const Sensor> sensors_of(std::size_t count);

const char* name_of(Sensor sensor);

}  // namespace bolt::hand
