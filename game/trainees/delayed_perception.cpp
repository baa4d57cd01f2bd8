#include "game/trainees/delayed_perception.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::trainees {

namespace {

constexpr double smoothing = 0.03;  // s
// Of the nut's turning, over which a hand tells how fast the torque grows; of the steepest growth, below
// which it says that the bolt gives. Chosen: our bolts grow by a fifth of it within 2° past the elastic
// limit.
constexpr double slope_over = to_radians(1.5);
constexpr double gives_below = 0.4;
constexpr double sticks_below = 0.2;  // of the hand's turning: the nut sticks

}  // namespace

double felt_torque(const force::TorqueRendering& rendering, const servo::NutGeometry& nut, const Vec3& handle,
                   const force::OutputCommand& output) {
    if (rendering.scale > 0.0) return glm::dot(output.torque, nut.axis) / rendering.scale;
    if (rendering.as_force <= 0.0) return 0.0;
    return glm::dot(output.force, glm::cross(nut.axis, handle)) / rendering.as_force;
}

Nerves::Nerves(double reaction, double dt, double stiffness)
    : dt_(dt), stiffness_(stiffness), line_(static_cast<std::size_t>(reaction / dt) + 1) {}

// The nut's turning is the hand's without what the wrench gives. While that is next to nothing the nut sticks
// or the jaw is in its play: no slope of the joint's.
void Nerves::follow_slope(const Moment& late) {
    const Moment nut{late.torque, late.turned - late.torque / stiffness_, 0.0, late.on};
    const double share = std::min(1.0, dt_ / smoothing);
    hand_rate_ += (late.turned - hand_ - hand_rate_) * share;
    nut_rate_ += (nut.turned - nut_ - nut_rate_) * share;
    hand_ = late.turned;
    nut_ = nut.turned;
    if (!late.on) {
        steepest_ = hand_rate_ = nut_rate_ = 0.0;
        now_.yields = false;
    }
    const bool turns = nut_rate_ > sticks_below * hand_rate_ && nut_rate_ > 0.0;
    if (!late.on || !mark_.on || !turns) {
        mark_ = nut;
        return;
    }
    const double turned = nut.turned - mark_.turned;
    if (turned < slope_over) return;
    const double slope = (nut.torque - mark_.torque) / turned;
    steepest_ = std::max(steepest_, slope);
    now_.yields = slope < gives_below * steepest_;
    mark_ = nut;
}

const Feeling& Nerves::feel(double torque, double turned, double nut_speed, bool on, bool clicked) {
    const Moment late = line_[at_];
    line_[at_] = {torque, turned, nut_speed, on, clicked};
    at_ = (at_ + 1) % line_.size();
    const double rate = (late.torque - now_.torque) / dt_;
    now_.torque_rate += (rate - now_.torque_rate) * std::min(1.0, dt_ / smoothing);
    now_.torque = late.torque;
    now_.nut_speed = late.nut_speed;
    now_.clicked = late.clicked;
    follow_slope(late);
    return now_;
}

}  // namespace bolt::trainees
