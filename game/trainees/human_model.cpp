#include "game/trainees/human_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::trainees {

namespace {

constexpr double fading = 0.1;  // s

// One implicit step of m v' + b v + k x = F; the spring gives `most` at most.
void swing(Vec3& x, Vec3& v, const Vec3& force, double m, double b, double k, double most, double dt) {
    const double far = glm::length(x);
    if (k * far > most) k = most / far;
    v = (v + (dt / m) * (force - k * x)) / (1.0 + dt * b / m + dt * dt * k / m);
    x += dt * v;
}

}  // namespace

void take_up(Arm& arm, const Pose& pose, const Pose& meant) {
    arm = {};
    arm.offset = pose.position - meant.position;
    arm.turn = rotation_vector(glm::normalize(pose.orientation * glm::conjugate(meant.orientation)));
}

Pose follow(const Impedance& i, Arm& arm, const Pose& meant, const force::OutputCommand& felt, bool grips,
            double dt) {
    if (grips) {
        const double left = std::max(0.0, 1.0 - dt / fading);
        arm.offset *= left;
        arm.turn *= left;
        arm.velocity = arm.rate = Vec3(0.0);
    } else {
        swing(arm.offset, arm.velocity, felt.force, i.mass, i.damping, i.stiffness, i.force, dt);
        swing(arm.turn, arm.rate, felt.torque, i.inertia, i.angular_damping, i.angular_stiffness, i.torque,
              dt);
    }
    return {meant.position + arm.offset, glm::normalize(rotation(arm.turn) * meant.orientation)};
}

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

namespace {

constexpr Profile profiles[] = {
    {.name = "expert",
     .reach_time = 0.9,
     .placing_time = 0.4,
     .position_noise = 0.3e-3,
     .angle_noise = to_radians(0.25),
     .tremor = 0.10e-3,
     .tremor_torsion = to_radians(0.02),
     .pull_speed = to_radians(45),
     .load_rate = 1.6,
     .final_rate = 0.12,
     .spin_speed = to_radians(520),
     .stroke = to_radians(50),
     .reaction = 0.14,
     .torque_bias = 0.03,
     .torque_noise = 0.015,
     .anticipation = 1.0,
     .feels_yield = 1.0,
     .content = 0.8,
     .pause = 0.15,
     .wrong_joint = 0.0,
     .stops_early = 0.0,
     .overdoes = 0.0},
    {.name = "novice",
     .reach_time = 1.5,
     .placing_time = 0.8,
     .position_noise = 0.7e-3,
     .angle_noise = to_radians(0.7),
     .tremor = 0.20e-3,
     .tremor_torsion = to_radians(0.05),
     .pull_speed = to_radians(35),
     .load_rate = 2.0,
     .final_rate = 0.25,
     .spin_speed = to_radians(360),
     .stroke = to_radians(38),
     .reaction = 0.20,
     .torque_bias = 0.04,
     .torque_noise = 0.06,
     .anticipation = 0.5,
     .feels_yield = 0.8,
     .content = 0.6,
     .pause = 0.8,
     .wrong_joint = 0.03,
     .stops_early = 0.05,
     .overdoes = 0.0},
    {.name = "clumsy",
     .reach_time = 1.3,
     .placing_time = 0.7,
     .position_noise = 1.2e-3,
     .angle_noise = to_radians(1.2),
     .tremor = 0.40e-3,
     .tremor_torsion = to_radians(0.12),
     .pull_speed = to_radians(70),
     .load_rate = 2.2,
     .final_rate = 0.35,
     .spin_speed = to_radians(400),
     .stroke = to_radians(45),
     .reaction = 0.26,
     .torque_bias = 0.06,
     .torque_noise = 0.10,
     .anticipation = 0.4,
     .feels_yield = 0.3,
     .content = 0.4,
     .pause = 0.5,
     .wrong_joint = 0.10,
     .stops_early = 0.08,
     .overdoes = 0.08},
};

}  // namespace

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const Profile& profile : profiles) names.emplace_back(profile.name);
    return names;
}

Result<Profile> find_profile(std::string_view name) {
    for (const Profile& profile : profiles)
        if (profile.name == name) return profile;
    const std::vector<std::string> names = profile_names();
    const std::string best = nearest(name, names);
    return fail(ErrorCode::usage, fmt::format("there is no simulated trainee \"{}\"", name),
                best.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                             : fmt::format("did you mean {}?", best));
}

}  // namespace bolt::trainees
