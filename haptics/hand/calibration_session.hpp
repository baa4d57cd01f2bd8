// Guides a trainee through the four calibration postures. Each is sampled while the hand is still; the result
// includes a quality score. Pure: its inputs are frames and time.
#pragma once

#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_frames.hpp"

namespace bolt::hand {

enum class CalibrationPhase : std::uint8_t {
    moving,   // waiting for the hand to reach the posture and rest
    holding,  // sampling the posture
    done,     // `result` is set
    failed,   // no sensor moved between postures; start again
};

enum class CalibrationTrouble : std::uint8_t { none, silent, restless, unmoved };

struct CalibrationSessionOptions {
    double settle = 0.3;     // s of rest before sampling starts
    double hold = 2.0;       // s of sampling
    double still = 8.0;      // counts that a sensor may deviate while the hand is still
    double moved = 12.0;     // counts by which at least one sensor must differ from the last posture
    double silence = 0.25;   // s without a frame until sampling restarts
    double patience = 20.0;  // s in one posture until the trouble is shown
};

struct CalibrationSession {
    CalibrationSessionOptions options;
    CalibrationPhase phase = CalibrationPhase::moving;
    Posture requested = Posture::flat;
    double held_for = 0.0;  // s of `hold` sampled so far, for a progress bar
    CalibrationTrouble trouble = CalibrationTrouble::none;
    std::optional<CalibrationResult> result;

    std::vector<PostureSamples> taken;
    PerSensor<std::uint8_t> rest{};  // readings when the hand came to rest
    double still_since = 0.0, last_frame = 0.0, requested_since = 0.0;
    bool started = false;
};

// The instruction for a posture.
const char* prompt(Posture posture);
const char* message_for(CalibrationTrouble trouble);  // empty for none

// `frame`: received since the last call, or null. `now`: s on a monotonic clock. Call at least every 0.1 s.
void update(CalibrationSession& session, const GloveFrame* frame, double now);

}  // namespace bolt::hand
