#include "game/measure/simulated_rig.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::measure {

namespace {

constexpr double tick = 0.001;         // s
constexpr double longest_run = 120.0;  // s
constexpr std::uint64_t sensor_stream = 77;

double rounded(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

// The operator's hand: speed of the wrench over time, and whether it pulls.
class Operator {
  public:
    Operator(const SensorModel& model, Random& random) : model_(model), random_(random) { next_stroke(); }

    // The hand in a tick.
    struct Pull {
        bool engaged = false;  // false while the hand returns
        bool begins = false;
        double turned = 0.0;  // rad
    };
    Pull advance() {
        time_ += tick;
        if (time_ > duration_ + model_.pause) {
            next_stroke();
            time_ = tick;
        }
        if (time_ > duration_) return {};
        // sin² profile: its mean is half of the highest speed.
        unsteady_ += (random_.normal() - unsteady_) * tick / 0.08;
        const double speed = speed_ * square(std::sin(pi * time_ / duration_)) * (1.0 + 0.5 * unsteady_);
        return {true, time_ <= 1.5 * tick, std::max(0.0, speed) * tick};
    }

  private:
    void next_stroke() {
        speed_ = model_.speed * (1.0 + 0.1 * random_.normal());
        duration_ = 2.0 * model_.stroke * (1.0 + 0.15 * random_.uniform(-1.0, 1.0)) / speed_;
    }

    const SensorModel& model_;
    Random& random_;
    double time_ = 0.0, duration_ = 1.0, speed_ = 0.0, unsteady_ = 0.0;
};

}  // namespace

std::vector<SensorRow> simulate_run(const joint::JointDesign& design, double torque, std::uint64_t seed,
                                    const SensorModel& model, double lead_in) {
    joint::JointDesign bolt = design;
    bolt.start_gap = lead_in * design.thread.thread.pitch / (2.0 * pi);
    const joint::GroupParameters group = joint::make_group({&bolt, 1}, nullptr, seed);
    std::vector<joint::JointState> joints = joint::initial_state(group, 1);
    Random random(seed, sensor_stream);
    const double gain = 1.0 + model.gain_error * random.normal();
    Operator hand(model, random);
    joint::NutDrive drive;
    drive.stiffness = model.wrench_stiffness;
    std::vector<SensorRow> rows;
    const auto every = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / (model.rate * tick))));
    double after_end = 0.0;  // s since the torque was reached
    double release = 0.0;    // rad in a tick by which the hand gives way at the end of a stroke
    for (std::size_t i = 0;
         static_cast<double>(i) * tick < longest_run && after_end < model.release + model.pause; ++i) {
        const double time = static_cast<double>(i) * tick;
        const bool done = after_end > 0.0 || joints[0].condition != joint::JointCondition::intact;
        Operator::Pull pull;
        if (time >= model.rest && !done) pull = hand.advance();
        if (pull.begins || !drive.engaged) drive.angle = joints[0].nut.angle;
        if (pull.engaged)
            release = (drive.angle - joints[0].nut.angle) * tick / model.release;
        else
            drive.angle = std::max(joints[0].nut.angle, drive.angle - release);
        drive.engaged = pull.engaged || drive.angle > joints[0].nut.angle;
        drive.angle += pull.turned;
        joint::step_group(group, joints, drive.engaged ? 0 : -1, drive, tick);
        const double applied = drive.engaged ? joints[0].torque : 0.0;
        if (done || applied >= torque) after_end += tick;
        if (i % every != 0) continue;
        const double force = gain * applied / model.lever + model.force_offset + model.force_drift * time +
                             model.force_noise * random.normal();
        rows.push_back(
            {time, rounded(force, model.force_resolution),
             rounded(joints[0].nut.angle + applied / model.arm_stiffness, model.angle_resolution)});
    }
    return rows;
}

std::string sensor_csv(const std::vector<SensorRow>& rows) {
    std::string out = "t,Fx,phi\n";
    for (const SensorRow& row : rows)
        out += fmt::format("{:.3f},{:.2f},{:.2f}\n", row.time, row.force, to_degrees(row.angle));
    return out;
}

std::string simulated_rig_json(const SensorModel& model, const std::string& title,
                               const std::string& thread) {
    nlohmann::ordered_json rig;
    rig["format"] = "boltwright rig 1";
    rig["title"] = title;
    rig["source"] = simulated_source;
    rig["direction"] = "tighten";
    if (!thread.empty()) rig["thread"] = thread;
    rig["time"] = {{"column", "t"}, {"unit", "s"}};
    rig["torque"] = {{"column", "Fx"},
                     {"unit", "N"},
                     {"lever_mm", 1e3 * model.lever},
                     {"tare_s", 0.9 * model.rest},
                     {"low_pass_Hz", 20.0},
                     {"resolution", model.force_resolution},
                     {"uncertainty_percent", 200.0 * model.gain_error}};
    rig["angle"] = {{"column", "phi"}, {"unit", "deg"}, {"resolution", to_degrees(model.angle_resolution)}};
    return rig.dump(2) + "\n";
}

}  // namespace bolt::measure
