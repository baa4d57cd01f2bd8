#include "haptics/hand/calibration_session.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::hand {
namespace {

double furthest(const PerSensor<std::uint8_t>& a, const PerSensor<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < sensor_count; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

void wait(CalibrationSession& session, double now) {
    if (session.phase == CalibrationPhase::holding) session.taken.pop_back();
    session.phase = CalibrationPhase::moving;
    session.held_for = 0.0;
    session.still_since = now;
}

void finish(CalibrationSession& session) {
    Result<CalibrationResult> calibrated = calibrate(session.taken);
    session.phase = calibrated ? CalibrationPhase::done : CalibrationPhase::failed;
    session.trouble = calibrated ? CalibrationTrouble::none : CalibrationTrouble::unmoved;
    if (calibrated) session.result = std::move(*calibrated);
}

// The posture has been sampled long enough.
void next(CalibrationSession& session, double now) {
    const auto number = static_cast<std::size_t>(session.requested) + 1;
    session.trouble = CalibrationTrouble::none;
    session.held_for = 0.0;
    if (number == posture_count) return finish(session);
    session.phase = CalibrationPhase::moving;
    session.requested = static_cast<Posture>(number);
    session.requested_since = session.still_since = now;
}

}  // namespace

const char* prompt(Posture posture) {
    switch (posture) {
        case Posture::flat:
            return "Hold the hand flat, fingers and thumb straight and side by side.";
        case Posture::fist:
            return "Make a fist, the thumb outside.";
        case Posture::spread:
            return "Hold the hand flat and spread fingers and thumb as wide as they go.";
        case Posture::thumb_across:
            return "Lay the bent thumb across the palm of the flat hand.";
    }
    return "";
}

const char* message_for(CalibrationTrouble trouble) {
    switch (trouble) {
        case CalibrationTrouble::none:
            return "";
        case CalibrationTrouble::silent:
            return "The glove gives nothing; is it switched on and plugged in?";
        case CalibrationTrouble::restless:
            return "Take the posture and hold the hand still for two seconds.";
        case CalibrationTrouble::unmoved:
            return "No sensor moved between the postures; is the glove on a hand?";
    }
    return "";
}

void update(CalibrationSession& session, const GloveFrame* frame, double now) {
    if (session.phase == CalibrationPhase::done || session.phase == CalibrationPhase::failed) return;
    if (!session.started) {
        session.started = true;
        session.requested_since = session.still_since = session.last_frame = now;
    }
    if (now - session.last_frame > session.options.silence) {
        wait(session, now);
        session.trouble = CalibrationTrouble::silent;
    }
    if (frame == nullptr) return;
    if (session.trouble == CalibrationTrouble::silent) session.trouble = CalibrationTrouble::none;
    session.last_frame = now;
    if (furthest(frame->raw, session.rest) > session.options.still) {
        wait(session, now);
        session.rest = frame->raw;
    }
    if (session.phase == CalibrationPhase::moving) {
        if (now - session.requested_since > session.options.patience)
            session.trouble = CalibrationTrouble::restless;
        const bool left =
            session.taken.empty() ||
            furthest(session.rest, session.taken.back().samples.front()) >= session.options.moved;
        if (!left || now - session.still_since < session.options.settle) return;
        session.phase = CalibrationPhase::holding;
        session.taken.push_back({session.requested, {}});
        session.still_since = now;
    }
    session.taken.back().samples.push_back(frame->raw);
    session.held_for = now - session.still_since;
    if (session.held_for >= session.options.hold) next(session, now);
}

}  // namespace bolt::hand
