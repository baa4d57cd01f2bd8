#include "haptics/station/stiffness_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/station/station_tick.hpp"

namespace bolt::station {

namespace {

constexpr double max_step = 3e-3;                       // m, of the spring's centre
constexpr double early_begin = 0.05, early_end = 0.30;  // s of a level
constexpr double late_begin = 0.60;                     // s; the late part lasts until the end of the level

// A swing counts if it is larger than min_swing (the criterion of tests/stability) and larger than the swing
// that the tremor of a resting hand causes on the spring.
constexpr double min_swing = 100e-6, tremor_force = 0.15;  // m, N
constexpr double lasting_share = 0.3;                      // late swing as a share of the early swing
constexpr double large_swing = 0.5e-3;  // m; a larger late swing counts whatever the early swing was
constexpr int min_crossings = 4;        // of the swing's middle; a moving hand makes fewer
// J in the late part. A hand that moves at 1 cm/s receives 0.2 mJ from 5 N/mm with 1.5 ms of delay.
constexpr double max_energy = 0.5e-3;
constexpr double visible_motion = 30e-6;  // m, more than the steps of encoders

double stored_energy(double stiffness, const Vec3& stretch) {
    return 0.5 * stiffness * glm::dot(stretch, stretch);
}

struct Swing {
    double width = 0.0;  // m
    int crossings = 0;   // of its middle
};

// Along the axis with the largest swing, without a steady drift.
Swing swing_of(const std::vector<Vec3>& positions) {
    Swing largest;
    if (positions.size() < 2) return largest;
    const auto n = static_cast<double>(positions.size() - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const double first = positions.front()[axis], drift = (positions.back()[axis] - first) / n;
        double low = 0.0, high = 0.0;
        const auto steady = [&](std::size_t i) {
            return positions[i][axis] - first - drift * static_cast<double>(i);
        };
        for (std::size_t i = 0; i < positions.size(); ++i) {
            low = std::min(low, steady(i));
            high = std::max(high, steady(i));
        }
        if (high - low <= largest.width) continue;
        largest = {high - low, 0};
        const double middle = 0.5 * (low + high), margin = 0.15 * (high - low);
        int side = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const double off = steady(i) - middle;
            const int now = off > margin ? 1 : off < -margin ? -1 : side;
            largest.crossings += side != 0 && now != side ? 1 : 0;
            side = now;
        }
    }
    return largest;
}

bool keeps_oscillating(const StiffnessTrial& t) {
    const Swing early = swing_of(t.early), late = swing_of(t.late);
    const double min_width = std::max(min_swing, tremor_force / stiffness_of(t, t.level));
    return late.crossings >= min_crossings && late.width > min_width &&
           (late.width > lasting_share * early.width || late.width > large_swing);
}

void end_level(StiffnessTrial& t) {
    if (t.moved_at) t.responses.push_back(*t.moved_at);
    if (keeps_oscillating(t))
        t.end = TrialEnd::oscillation;
    else if (t.generated > max_energy)
        t.end = TrialEnd::energy;
    else
        t.stable = stiffness_of(t, t.level);
    if (t.end != TrialEnd::none) return;
    if (t.level + 1 == stiffness_levels) {
        t.end = TrialEnd::rendered_as_reported;
        return;
    }
    ++t.level;
    t.time = 0.0;
}

// Moves the spring's centre by a step, so that the handle swings.
void begin_level(StiffnessTrial& t, const Vec3& position) {
    const double step = std::min(max_step, t.limits.force / stiffness_of(t, t.level));
    t.centre = position;
    t.offset = (t.level % 2 == 0 ? step : -step) * t.direction;
    t.moved_at.reset();
    t.early.clear();
    t.late.clear();
    t.generated = 0.0;
}

// Positions and energy of a tick with a new sample.
void record_sample(StiffnessTrial& t, const Vec3& position, double stored) {
    if (!t.moved_at && std::abs(glm::dot(position - t.centre, t.direction)) > visible_motion)
        t.moved_at = t.time;
    if (t.time >= early_begin && t.time < early_end) t.early.push_back(position);
    if (t.time >= late_begin) {
        const auto delay = static_cast<std::size_t>(std::clamp(t.limits.delay, 0, 3));
        const force::OutputCommand& applied = t.output_stage.passivity.sent[delay];
        if (!t.late.empty())
            t.generated += glm::dot(applied.force, position - t.late.back()) + stored - t.energy_before;
        t.late.push_back(position);
    }
    t.energy_before = stored;
}

}  // namespace

double stiffness_of(const StiffnessTrial& trial, int level) {
    return trial.limits.stiffness * (level + 1) / stiffness_levels;
}

StiffnessTrial begin_stiffness_trial(const device::Description& arm) {
    StiffnessTrial t;
    t.limits = arm.limits;
    t.limits.force *= trial_force_share;
    t.limits.torque = 0.0;
    t.limits.release -= transport_delay;
    for (int i = 0; i < 3; ++i) t.direction[i] = arm.renders[static_cast<std::size_t>(i)] ? 1.0 : 0.0;
    t.direction = glm::normalize(t.direction);
    constexpr std::size_t room = 1000;  // samples, reserved so that a tick does not allocate
    t.early.reserve(room);
    t.late.reserve(room);
    t.responses.reserve(stiffness_levels);
    return t;
}

force::OutputCommand step(StiffnessTrial& t, const force::DeviceInput& given, double dt) {
    force::DeviceInput input = given;
    input.dead_man = given.dead_man && t.end == TrialEnd::none;
    const Vec3 position = given.pose.position;
    if (!t.has_centre && given.fresh) t.centre = position;
    t.has_centre = t.has_centre || given.fresh;
    const double stiffness = stiffness_of(t, t.level);

    force::ForceRequest request;
    const bool at_full_force = input.dead_man && t.output_stage.limiter.ramp >= 1.0;
    if (!at_full_force) {
        t.time = 0.0;
        t.offset = Vec3(0.0);
        if (!input.dead_man) t.centre = position;
    } else if (t.time == 0.0) {
        const double before = stored_energy(stiffness, t.centre + t.offset - position);
        begin_level(t, position);
        request.injected_energy = stored_energy(stiffness, t.offset) - before;
    }
    const Vec3 stretch = t.centre + t.offset - position;
    request.command.force = stiffness * stretch;
    request.stored_energy = stored_energy(stiffness, stretch);
    if (at_full_force && given.fresh) record_sample(t, position, request.stored_energy);
    // Time passes without a sample too: an arm may send fewer than one a tick.
    if (at_full_force) t.time += dt * (1.0 + given.missed);
    const force::OutputCommand command = force::render(t.limits, t.output_stage, input, request, dt);
    if (t.end != TrialEnd::none) return command;
    if (at_full_force && t.output_stage.watchdog.fault != force::Fault::none) {
        t.end = TrialEnd::fault;
        t.fault = t.output_stage.watchdog.fault;
    } else if (at_full_force && t.time >= stiffness_level_time) {
        end_level(t);
    }
    return command;
}

std::optional<double> median_response(const StiffnessTrial& trial) {
    if (trial.responses.empty()) return {};
    std::vector<double> sorted = trial.responses;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
}

}  // namespace bolt::station
