// The bend sensors of a CyberGlove: which there are and in which order a glove of 18 or 22 gives them.
// Kessler, Hodges and Walker, "Evaluation of the CyberGlove as a whole-hand input device", ACM TOCHI 2(4),
// 1995.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace bolt::glove {

// In the order of a glove with all 22. MPJ: the knuckle; PIJ and DIJ: the joints beyond; IJ: the thumb's
// last.
enum class Sensor : std::uint8_t {
    thumb_roll,  // of the thumb across the palm
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
inline constexpr std::size_t all_sensors = 22;

// A value each, by Sensor.
template <class T>
using BySensor = std::array<T, all_sensors>;

constexpr std::size_t index(Sensor sensor) { return static_cast<std::size_t>(sensor); }

// The sensors that a glove of so many has, in the order of its samples; none for another number. A glove of
// 18 lacks the four DIJ.
std::span<const Sensor> sensors_of(std::size_t count);

const char* name_of(Sensor sensor);

}  // namespace bolt::glove
