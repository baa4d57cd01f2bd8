#include "haptics/glove/calibration_session.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::glove {
namespace {

double furthest(const BySensor<std::uint8_t>& a, const BySensor<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < all_sensors; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

void wait(CalibrationSession& session, double now) {
    if (session.phase == Phase::holding) session.taken.pop_back();
    session.phase = Phase::moving;
    session.held_for = 0.0;
    session.still_since = now;
}

void finish(CalibrationSession& session) {
    Result<Calibrated> calibrated = calibrate(session.taken);
    session.phase = calibrated ? Phase::done : Phase::failed;
    session.trouble = calibrated ? Trouble::none : Trouble::unmoved;
    if (calibrated) session.result = std::move(*calibrated);
}

// The posture was held long enough.
void next(CalibrationSession& session, double now) {
    const auto number = static_cast<std::size_t>(session.asked) + 1;
    session.trouble = Trouble::none;
    session.held_for = 0.0;
    if (number == poses) return finish(session);
    session.phase = Phase::moving;
    session.asked = static_cast<Posture>(number);
    session.asked_since = session.still_since = now;
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

const char* words(Trouble trouble) {
    switch (trouble) {
        case Trouble::none:
            return "";
        case Trouble::silent:
            return "The glove gives nothing; is it switched on and plugged in?";
        case Trouble::restless:
            return "Take the posture and hold the hand still for two seconds.";
        case Trouble::unmoved:
            return "No sensor moved between the postures; is the glove on a hand?";
    }
    return "";
}

void go_on(CalibrationSession& session, const Frame* frame, double now) {
    if (session.phase == Phase::done || session.phase == Phase::failed) return;
    if (!session.started) {
        session.started = true;
        session.asked_since = session.still_since = session.last_frame = now;
    }
    if (now - session.last_frame > session.options.silence) {
        wait(session, now);
        session.trouble = Trouble::silent;
    }
    if (frame == nullptr) return;
    if (session.trouble == Trouble::silent) session.trouble = Trouble::none;
    session.last_frame = now;
    if (furthest(frame->raw, session.rest) > session.options.still) {
        wait(session, now);
        session.rest = frame->raw;
    }
    if (session.phase == Phase::moving) {
        if (now - session.asked_since > session.options.patience) session.trouble = Trouble::restless;
        const bool left =
            session.taken.empty() ||
            furthest(session.rest, session.taken.back().samples.front()) >= session.options.moved;
        if (!left || now - session.still_since < session.options.settle) return;
        session.phase = Phase::holding;
        session.taken.push_back({session.asked, {}});
        session.still_since = now;
    }
    session.taken.back().samples.push_back(frame->raw);
    session.held_for = now - session.still_since;
    if (session.held_for >= session.options.hold) next(session, now);
}

}  // namespace bolt::glove
