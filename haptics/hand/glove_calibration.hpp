// Calibration of a glove: maps readings to angles by one linear fit per sensor, angle = gain × (raw −
// offset), the form that the vendor's software uses. The fits come from postures through which a
// CalibrationSession guides the trainee, or from the vendor's calibration file.
//
// Angles in rad. Flexion: 0 with the hand flat, positive towards the palm. Abduction: 0 with the fingers side
// by side, positive apart; the thumb's is 0 at the index finger. Thumb roll: 0 in the palm's plane, positive
// across it. Palm arch: positive hollow. Wrist pitch: positive towards the palm; wrist yaw: towards the
// thumb.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/hand/glove_protocol.hpp"

namespace bolt::hand {

struct LinearFit {
    double gain = 0.0;    // rad per count
    double offset = 0.0;  // counts at 0 rad
};

constexpr double angle(const LinearFit& fit, double raw) { return fit.gain * (raw - fit.offset); }

struct Calibration {
    PerSensor<std::optional<LinearFit>> fits;  // nullopt: not calibrated, or the glove has no such sensor
};

// The calibration postures, in the order in which a session requests them.
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
    double span = 0.0;   // counts between the postures
    double noise = 0.0;  // rad, standard deviation within a posture
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

// Least-squares fit through the medians of the postures. Errors: flat hand or fist is missing, a posture has
// no samples, or no sensor has readings in two postures.
Result<CalibrationResult> calibrate(std::span<const PostureSamples> postures);

// Parses the calibration file of the vendor's software: a title line, then a heading and four lines for each
// finger and the palm. The sixth word of a line is a sensor's offset (counts), the ninth its gain (rad per
// count). The fourth line exists even for fingers without a fourth sensor; the gain of the middle finger's
// abduction is in the index finger's fourth line, where the vendor's software writes it. Errors name `file`,
// line and column.
Result<Calibration> parse_cal(std::string_view text, const std::string& file);

enum class CalibrationPhase : std::uint8_t {
    moving,   // waiting for the hand to reach the posture and rest
    holding,  // sampling the posture
    done,     // `result` is set
    failed,   // `failure` is set; start again
};

enum class CalibrationProblem : std::uint8_t {
    none,
    silent,   // the glove sends no frames
    restless  // the hand has not held the posture still
};

struct CalibrationSessionOptions {
    double settle = 0.3;          // s of rest before sampling starts
    double hold = 2.0;            // s of sampling
    double still = 8.0;           // counts that a sensor may deviate while the hand is still
    double moved = 12.0;          // counts by which at least one sensor must differ from the last posture
    double silence = 0.25;        // s without a frame until sampling restarts
    double problem_delay = 20.0;  // s in one posture until `restless` is reported
};

// Guides a trainee through the four calibration postures. Each is sampled while the hand is still; the result
// includes a quality score. Pure: its inputs are frames and time.
struct CalibrationSession {
    CalibrationSessionOptions options;
    CalibrationPhase phase = CalibrationPhase::moving;
    Posture requested = Posture::flat;
    double held_for = 0.0;  // s of `hold` sampled so far, for a progress bar
    CalibrationProblem problem = CalibrationProblem::none;
    std::optional<CalibrationResult> result;
    std::optional<Error> failure;

    std::vector<PostureSamples> taken;  // the postures sampled so far
    PerSensor<std::uint8_t> rest{};     // readings when the hand came to rest
    // s, times on the clock of update(). `still_since`: the hand came to rest or, while `holding`, sampling
    // began.
    double still_since = 0.0, last_frame = 0.0, requested_since = 0.0;
    bool started = false;  // update() has been called
};

// The instruction for a posture.
const char* prompt(Posture posture);
const char* message_for(CalibrationProblem problem);  // empty for none

// `frame`: received since the last call, or null. `now`: s on a monotonic clock. Call at least every 0.1 s.
void update(CalibrationSession& session, const GloveFrame* frame, double now);

}  // namespace bolt::hand
