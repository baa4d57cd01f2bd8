// Maps glove readings to angles by one linear fit per sensor, angle = gain × (raw − offset), the form that
// the vendor's software uses. Postures of the trainee determine the fits and their quality.
//
// Angles in rad. Flexion: 0 with the hand flat, positive towards the palm. Abduction: 0 with the fingers side
// by side, positive apart; the thumb's is 0 at the index finger. Thumb roll: 0 in the palm's plane, positive
// across it. Palm arch: positive hollow. Wrist pitch: positive towards the palm; wrist yaw: towards the
// thumb.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/hand/glove_sensors.hpp"

namespace bolt::hand {

struct LinearFit {
    double gain = 0.0;    // rad per count
    double offset = 0.0;  // counts at 0 rad
};

constexpr double angle(const LinearFit& fit, double raw) { return fit.gain * (raw - fit.offset); }

struct Calibration {
    PerSensor<std::optional<LinearFit>> fits;  // nullopt: not calibrated, or the glove has no such sensor
};

// Requested in this order.
enum class Posture : std::uint8_t { flat, fist, spread, thumb_across };
inline constexpr std::size_t posture_count = 4;

// The nominal angle of a sensor's joint in a posture; nullopt if the posture does not define it or people
// differ too much. Chosen near the normal ranges of goniometry; individual hands deviate by 10° to 15°.
std::optional<double> posture_angle(Posture posture, Sensor sensor);

// The samples of one posture.
struct PostureSamples {
    Posture posture = Posture::flat;
    std::vector<PerSensor<std::uint8_t>> samples;
};

struct SensorQuality {
    double span = 0.0;      // counts between the postures
    double noise = 0.0;     // rad, standard deviation within a posture
    double residual = 0.0;  // rad, greatest deviation of a posture from the fit
};

struct CalibrationResult {
    Calibration calibration;
    PerSensor<SensorQuality> quality;
    // 1: all sensors are as good as a glove allows; 0: at least one is unusable. The minimum over the
    // sensors.
    double score = 0.0;
    std::vector<std::string> remarks;  // advice for the trainee; empty: none
};

// A span this small (counts) or noise this large (rad) halves a sensor's score.
inline constexpr double poor_span = 12.0;
inline constexpr double poor_noise = 3.0 * pi / 180.0;

// Least-squares fit through the medians of the postures. Errors: flat hand or fist is missing, or a posture
// has no samples.
Result<CalibrationResult> calibrate(std::span<const PostureSamples> postures);

}  // namespace bolt::hand
