#include "game/trainees/human_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::trainees {

namespace {

constexpr double fade_time = 0.1;  // s, of the deflection while the hand holds a nut

// One implicit step of m v' + b v + k x = F. The spring's force is limited to `max_spring_force`.
void step_spring(Vec3& x, Vec3& v, const Vec3& force, double m, double b, double k, double max_spring_force,
                 double dt) {
    const double distance = glm::length(x);
    if (k * distance > max_spring_force) k = max_spring_force / distance;
    v = (v + (dt / m) * (force - k * x)) / (1.0 + dt * b / m + dt * dt * k / m);
    x += dt * v;
}

}  // namespace

void reset_deflection(HandDeflection& deflection, const Pose& pose, const Pose& intended) {
    deflection = {};
    deflection.offset = pose.position - intended.position;
    deflection.turn = turn_between(intended.orientation, pose.orientation);
}

Pose step_deflection(const Impedance& i, HandDeflection& deflection, const Pose& intended,
                     const force::OutputCommand& felt, bool holds_nut, double dt) {
    if (holds_nut) {
        const double remaining = std::max(0.0, 1.0 - dt / fade_time);
        deflection.offset *= remaining;
        deflection.turn *= remaining;
        deflection.velocity = deflection.rate = Vec3(0.0);
    } else {
        step_spring(deflection.offset, deflection.velocity, felt.force, i.mass, i.damping, i.stiffness,
                    i.max_force, dt);
        step_spring(deflection.turn, deflection.rate, felt.torque, i.inertia, i.angular_damping,
                    i.angular_stiffness, i.max_torque, dt);
    }
    return {intended.position + deflection.offset,
            glm::normalize(rotation(deflection.turn) * intended.orientation)};
}

namespace {

constexpr double smoothing = 0.03;  // s
// A trainee measures the slope of torque over a rotation of the nut of slope_interval, and perceives yielding
// at a slope below yield_slope of the steepest one. Both are chosen: 2° past the elastic limit the slope of
// our bolts has dropped to a fifth.
constexpr double slope_interval = to_radians(1.5);
constexpr double yield_slope = 0.4;
constexpr double stick_rate = 0.2;  // of the hand's rate; a nut that turns more slowly counts as stuck

}  // namespace

double felt_torque(const force::TorqueRendering& rendering, const servo::NutGeometry& nut, const Vec3& handle,
                   const force::OutputCommand& output) {
    const Vec3 axis = servo::loosening_axis(nut);
    if (rendering.scale > 0.0) return glm::dot(output.torque, axis) / rendering.scale;
    if (rendering.as_force <= 0.0) return 0.0;
    return glm::dot(output.force, glm::cross(axis, handle)) / rendering.as_force;
}

DelayedPerception::DelayedPerception(double reaction, double dt, double stiffness)
    : dt_(dt), stiffness_(stiffness), delay_line_(static_cast<std::size_t>(reaction / dt) + 1) {}

// The nut's rotation is the hand's less the deflection of wrench and wrist. While the nut hardly turns it is
// stuck, or the jaw moves within its play: there is no slope to measure.
void DelayedPerception::update_slope(const Stimulus& delayed) {
    const Stimulus nut{delayed.torque, delayed.turned - delayed.torque / stiffness_, 0.0, delayed.holds_nut};
    const double share = std::min(1.0, dt_ / smoothing);
    hand_rate_ += (delayed.turned - hand_angle_ - hand_rate_) * share;
    nut_rate_ += (nut.turned - nut_angle_ - nut_rate_) * share;
    hand_angle_ = delayed.turned;
    nut_angle_ = nut.turned;
    if (!delayed.holds_nut) {
        steepest_ = hand_rate_ = nut_rate_ = 0.0;
        percept_.yields = false;
    }
    const bool turns = nut_rate_ > stick_rate * hand_rate_ && nut_rate_ > 0.0;
    if (!delayed.holds_nut || !slope_start_.holds_nut || !turns) {
        slope_start_ = nut;
        return;
    }
    const double turned = nut.turned - slope_start_.turned;
    if (turned < slope_interval) return;
    const double slope = (nut.torque - slope_start_.torque) / turned;
    steepest_ = std::max(steepest_, slope);
    percept_.yields = slope < yield_slope * steepest_;
    slope_start_ = nut;
}

const Percept& DelayedPerception::update(double torque, double turned, double nut_speed, bool holds_nut,
                                         bool clicked) {
    const Stimulus delayed = delay_line_[next_];
    delay_line_[next_] = {torque, turned, nut_speed, holds_nut, clicked};
    next_ = (next_ + 1) % delay_line_.size();
    const double rate = (delayed.torque - percept_.torque) / dt_;
    percept_.torque_rate += (rate - percept_.torque_rate) * std::min(1.0, dt_ / smoothing);
    percept_.torque = delayed.torque;
    percept_.nut_speed = delayed.nut_speed;
    percept_.clicked = delayed.clicked;
    update_slope(delayed);
    return percept_;
}

namespace {

constexpr TraineeProfile profiles[] = {
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
     .wanted_visibility = 0.8,
     .pause = 0.15,
     .wrong_joint = 0.0,
     .stops_early = 0.0,
     .overtightens = 0.0,
     .forgets_second_wrench = 0.0},
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
     .wanted_visibility = 0.6,
     .pause = 0.8,
     .wrong_joint = 0.03,
     .stops_early = 0.05,
     .overtightens = 0.0,
     .forgets_second_wrench = 0.15},
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
     .wanted_visibility = 0.4,
     .pause = 0.5,
     .wrong_joint = 0.10,
     .stops_early = 0.08,
     .overtightens = 0.08,
     .forgets_second_wrench = 0.3},
};

}  // namespace

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const TraineeProfile& profile : profiles) names.emplace_back(profile.name);
    return names;
}

Result<TraineeProfile> find_profile(std::string_view name) {
    for (const TraineeProfile& profile : profiles)
        if (profile.name == name) return profile;
    const std::vector<std::string> names = profile_names();
    const std::string best = nearest(name, names);
    return fail(ErrorCode::usage, fmt::format("unknown simulated trainee \"{}\"", name),
                best.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                             : fmt::format("did you mean {}?", best));
}

}  // namespace bolt::trainees
