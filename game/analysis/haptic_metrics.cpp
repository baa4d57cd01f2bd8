#include "game/analysis/haptic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/session/session_file.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::analysis {

namespace {

constexpr double millisecond = 1e-3;   // s
constexpr double contact_gap = 0.1;    // s; contacts with a shorter gap are one contact
constexpr double near_nut = 0.04;      // m from the seat to the tool
constexpr double most_unknown = 0.1;   // share of the time near the nut whose visibility may be unknown
constexpr double min_jump_gap = 0.05;  // s between two separate force jumps
constexpr std::size_t max_force_jumps = 5;
constexpr double recent = 0.01;      // s
constexpr double large_share = 0.1;  // share of the device's maximum
constexpr double rounding = 1e-5;    // forces are recorded in single precision

Vec3 vector_of(const float (&v)[3]) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double elapsed(double time, double event) { return time - event; }

ChangeStatistics statistics_of(std::vector<float>& changes, double greatest_output, double limit) {
    ChangeStatistics out;
    out.ticks = changes.size();
    if (changes.empty()) return out;
    const auto at =
        changes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(changes.size() - 1));
    std::nth_element(changes.begin(), at, changes.end());
    out.p99 = static_cast<double>(*at);
    for (const float change : changes) {
        const auto c = static_cast<double>(change);
        out.greatest = std::max(out.greatest, c);
        if (greatest_output > 0.0 && c > large_share * greatest_output * (1.0 + rounding)) ++out.above;
        if (limit > 0.0 && c > limit * (1.0 - rounding)) ++out.at_limit;
    }
    return out;
}

}  // namespace

HapticMetricsBuilder::HapticMetricsBuilder(const session::Header& header,
                                           std::span<const lesson::LessonEvent> events,
                                           std::vector<Vec3> seats)
    : dt_(header.dt), seats_(std::move(seats)) {
    metrics_.has_contacts_and_faults = header.servo_rate.has_value();
    metrics_.has_contact_models = !header.contact_models.value_or("").empty();
    metrics_.guided = header.guiding_force.value_or(header.mode == lesson::Mode::guided);
    metrics_.device_limits = header.device_limits;
    if (header.servo_rate) metrics_.servo_text = session::servo_text(*header.servo_rate);
    for (const lesson::LessonEvent& event : events)
        if (event.kind == lesson::EventKind::step_begin)
            steps_.push_back({event.tick, event.joint});
        else if (event.kind == lesson::EventKind::visibility)
            visibilities_.push_back({event.tick, event.joint, event.value});
}

bool HapticMetricsBuilder::own_nut(collision::ObstacleId obstacle) const {
    if (!obstacle.is_nut()) return false;
    const auto joint = static_cast<int>(obstacle.index());
    return joint == due_ || joint == latest_.last_joint;
}

void HapticMetricsBuilder::update_grip(double time, const session::TickRecord& tick) {
    const int held_before = previous_ ? previous_->joint : -1;
    if (tick.joint >= 0 && held_before < 0) engaged_at_ = time;
    if (tick.joint < 0 && held_before >= 0) released_at_ = time;
    if (tick.joint >= 0) latest_.last_joint = tick.joint;
    if (arrived_ || due_ < 0) return;
    const auto due = static_cast<std::size_t>(due_);
    if (due < seats_.size() &&
        glm::length(vector_of(tick.commanded_tool.position) - seats_[due]) < near_nut) {
        near_nut_ += dt_;
        if (visibility_.joint != due_)
            visibility_unknown_ += dt_;
        else if (visibility_.share >= visible_fraction)
            nut_visible_ += dt_;
    }
    if (tick.joint != due_) return;
    arrived_ = true;
    const bool wrench = static_cast<servo::Grip>(tick.grip) == servo::Grip::wrench;
    const bool known = visibility_unknown_ <= most_unknown * near_nut_;
    metrics_.arrivals.push_back({due_, wrench, time - step_begun_, near_nut_, known ? nut_visible_ : nan});
}

void HapticMetricsBuilder::update_touch(double time, const session::TickRecord& tick) {
    const bool touched_before = previous_ && !previous_->touched.is_none();
    const bool touches = !tick.touched.is_none();
    const bool free = tick.joint < 0;
    if (touches && !touched_before) {
        touched_with_nut_ = !free;
        contact_begin_ = time;
    }
    if (!touches && touched_before) contact_end_ = time;
    if (touches) latest_.last_touched = tick.touched;
    const bool is_obstacle_contact = free && touches && !touched_with_nut_ && !own_nut(tick.touched);
    if (!is_obstacle_contact) {
        in_obstacle_contact_ = false;
        return;
    }
    std::vector<ObstacleContact>& all = metrics_.obstacle_contacts;
    const bool continues =
        in_obstacle_contact_ || (!all.empty() && time - all.back().begin - all.back().length < contact_gap);
    if (!continues) all.push_back({time, 0.0, tick.touched, 0.0});
    in_obstacle_contact_ = true;
    all.back().length = time + dt_ - all.back().begin;
    all.back().peak_force = std::max(all.back().peak_force, glm::length(vector_of(tick.force)));
}

void HapticMetricsBuilder::keep_force_jump(const ForceJump& jump) {
    std::vector<ForceJump>& kept = metrics_.force_jumps;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const ForceJump& other) {
        return std::abs(other.time - jump.time) < min_jump_gap;
    });
    if (same != kept.end()) {
        if (same->change >= jump.change) return;
        kept.erase(same);
    }
    const auto after = std::find_if(kept.begin(), kept.end(),
                                    [&](const ForceJump& other) { return other.change < jump.change; });
    kept.insert(after, jump);
    if (kept.size() > max_force_jumps) kept.pop_back();
}

void HapticMetricsBuilder::update_change(double time, const session::TickRecord& tick) {
    if (!previous_) return;
    const auto change = [&](const float(&now)[3], const float(&then)[3], std::vector<float>& all) {
        const Vec3 a = vector_of(now), b = vector_of(then);
        const double by = glm::length(a - b) * millisecond / dt_;
        const bool any = glm::dot(a, a) > 0.0 || glm::dot(b, b) > 0.0;
        if (any && std::isfinite(by)) all.push_back(static_cast<float>(by));
        return std::isfinite(by) ? by : 0.0;
    };
    (void)change(tick.torque, previous_->torque, torque_changes_);
    const double by = change(tick.force, previous_->force, force_changes_);
    const bool at_limit = metrics_.device_limits &&
                          by > metrics_.device_limits->force_slew_rate * millisecond * (1.0 - rounding);
    const bool large =
        metrics_.force_jumps.size() < max_force_jumps || by > metrics_.force_jumps.back().change;
    if (by <= 0.0 || !(large || at_limit)) return;
    ForceJump jump = latest_;
    jump.time = time;
    jump.change = by;
    jump.tick = tick;
    jump.since_engaged = elapsed(time, engaged_at_);
    jump.since_released = elapsed(time, released_at_);
    jump.since_contact_begin = elapsed(time, contact_begin_);
    jump.since_contact_end = elapsed(time, contact_end_);
    if (at_limit) ++metrics_.at_limit[static_cast<std::size_t>(activity_of(jump))];
    if (large) keep_force_jump(jump);
}

void HapticMetricsBuilder::add_tick(std::uint64_t number, const session::TickRecord& tick) {
    const double time = static_cast<double>(number) * dt_;
    while (next_step_ < steps_.size() && steps_[next_step_].tick <= number) {
        due_ = steps_[next_step_++].joint;
        arrived_ = false;
        step_begun_ = time;
        near_nut_ = nut_visible_ = visibility_unknown_ = 0.0;
    }
    while (next_visibility_ < visibilities_.size() && visibilities_[next_visibility_].tick <= number)
        visibility_ = visibilities_[next_visibility_++];
    update_grip(time, tick);
    update_touch(time, tick);
    update_change(time, tick);
    metrics_.faults[tick.fault] += dt_;
    previous_ = tick;
}

void HapticMetricsBuilder::add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks) {
    for (std::size_t i = 0; i < ticks.size(); ++i) add_tick(first_tick + i, ticks[i]);
}

HapticMetrics HapticMetricsBuilder::finish() {
    const force::OutputLimits none{
        .force = 0.0, .torque = 0.0, .force_slew_rate = 0.0, .torque_slew_rate = 0.0};
    const force::OutputLimits limits = metrics_.device_limits.value_or(none);
    metrics_.force = statistics_of(force_changes_, limits.force, limits.force_slew_rate * millisecond);
    metrics_.torque = statistics_of(torque_changes_, limits.torque, limits.torque_slew_rate * millisecond);
    metrics_.faults[0] = 0.0;
    return std::move(metrics_);
}

std::string obstacle_text(collision::ObstacleId id, const std::vector<session::ObstacleName>& obstacles) {
    const auto found = std::find_if(obstacles.begin(), obstacles.end(),
                                    [&](const session::ObstacleName& o) { return o.id == id; });
    return found != obstacles.end() ? found->name
                                    : fmt::format("{} {}", id.is_nut() ? "nut" : "obstacle", id.index());
}

ToolActivity activity_of(const ForceJump& jump) {
    if (jump.tick.fault != 0) return ToolActivity::output_off;
    if (jump.tick.joint < 0 && jump.since_released <= recent) return ToolActivity::releasing;
    if (jump.tick.joint >= 0)
        return jump.since_engaged <= recent ? ToolActivity::engaging : ToolActivity::on_nut;
    return !jump.tick.touched.is_none() || jump.since_contact_end <= recent ? ToolActivity::touching
                                                                            : ToolActivity::free;
}

std::string describe(const ForceJump& jump, const std::vector<lesson::JointResult>& joints,
                     const std::vector<session::ObstacleName>& obstacles) {
    const auto joint = [&](int j) {
        return j >= 0 && static_cast<std::size_t>(j) < joints.size() ? joints[static_cast<std::size_t>(j)].id
                                                                     : fmt::format("joint {}", j);
    };
    const char* const tool =
        static_cast<servo::Grip>(jump.tick.grip) == servo::Grip::fingers ? "fingers" : "wrench";
    const bool touches = !jump.tick.touched.is_none();
    std::string text;
    switch (activity_of(jump)) {
        case ToolActivity::output_off:
            return fmt::format("the output was switched off: {}",
                               force::message_for(static_cast<force::Fault>(jump.tick.fault)));
        case ToolActivity::releasing:
            text = fmt::format("the hand lets go of {}", joint(jump.last_joint));
            break;
        case ToolActivity::engaging:
            text = fmt::format("{} engages {}", tool, joint(jump.tick.joint));
            break;
        case ToolActivity::on_nut:
            text = fmt::format("{} on {}, {}, {:.1f} N·m", tool, joint(jump.tick.joint),
                               joint::name(static_cast<joint::Stage>(jump.tick.stage)),
                               static_cast<double>(jump.tick.wrench_torque));
            break;
        case ToolActivity::touching:
        case ToolActivity::free:
            text = jump.tick.guided_joint >= 0 ? fmt::format("led to {}", joint(jump.tick.guided_joint))
                                               : "in the air";
            break;
    }
    if (jump.since_contact_begin <= recent && touches)
        text += ", contact with " + obstacle_text(jump.tick.touched, obstacles) + " begins";
    else if (jump.since_contact_end <= recent && !touches)
        text += ", contact with " + obstacle_text(jump.last_touched, obstacles) + " ends";
    else if (touches)
        text += ", against " + obstacle_text(jump.tick.touched, obstacles);
    return text;
}

}  // namespace bolt::analysis
