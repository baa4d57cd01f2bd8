// The trainee is asked for the four postures, one after the other; each is taken when it is held still, and
// at the end it is told how good the calibration is. Pure: frames and time in.
#pragma once

#include "haptics/glove/calibration.hpp"
#include "haptics/glove/frames.hpp"

namespace bolt::glove {

enum class Phase : std::uint8_t {
    moving,   // towards the posture; or still as in the last one
    holding,  // it is being taken
    done,     // `result` says how good it is
    failed,   // nothing moved between the postures; begin anew
};

enum class Trouble : std::uint8_t { none, silent, restless, unmoved };

struct SessionOptions {
    double settle = 0.3;     // s of stillness before it is taken
    double hold = 2.0;       // s that it is held and taken
    double still = 8.0;      // counts that any sensor may be from where it came to rest
    double moved = 12.0;     // counts that some sensor must have gone since the last posture
    double silence = 0.25;   // s without a frame: what was held so far does not count
    double patience = 20.0;  // s in one posture until the trainee is told what to do
};

struct CalibrationSession {
    SessionOptions options;
    Phase phase = Phase::moving;
    Posture asked = Posture::flat;
    double held_for = 0.0;  // s of `hold`, for a bar to be shown
    Trouble trouble = Trouble::none;
    std::optional<Calibrated> result;

    std::vector<Held> taken;
    BySensor<std::uint8_t> rest{};  // where the hand came to rest
    double still_since = 0.0, last_frame = 0.0, asked_since = 0.0;
    bool started = false;
};

// What to tell the trainee to do.
const char* prompt(Posture posture);
const char* words(Trouble trouble);  // empty for none

// Time (s, of a clock that goes on), and the frame that came since the last call, if one came. To be called
// at least every 0.1 s.
void go_on(CalibrationSession& session, const Frame* frame, double now);

}  // namespace bolt::glove
