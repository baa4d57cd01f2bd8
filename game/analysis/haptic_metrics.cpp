#include "game/analysis/haptic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/session/session_file.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::analysis {

namespace {

constexpr double millisecond = 1e-3;  // s
constexpr double one_bump = 0.1;      // s: touches nearer to each other than this are one
constexpr double near_nut = 0.04;     // m from its seat, from where on a wrench is being placed
constexpr double apart = 0.05;        // s between two moments that are told apart
constexpr std::size_t most_moments = 5;
constexpr double just_now = 0.01;  // s
constexpr double tenth = 0.1;      // of the device's greatest force, in a millisecond
constexpr double rounding = 1e-5;  // forces are recorded in single precision

Vec3 vector_of(const float (&v)[3]) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double since(double time, double event) { return time - event; }

Changes summed_up(std::vector<float>& changes, double greatest_output, double limit) {
    Changes out;
    out.ticks = changes.size();
    if (changes.empty()) return out;
    const auto at =
        changes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(changes.size() - 1));
    std::nth_element(changes.begin(), at, changes.end());
    out.p99 = static_cast<double>(*at);
    for (const float change : changes) {
        const auto c = static_cast<double>(change);
        out.greatest = std::max(out.greatest, c);
        if (greatest_output > 0.0 && c > tenth * greatest_output * (1.0 + rounding)) ++out.above;
        if (limit > 0.0 && c > limit * (1.0 - rounding)) ++out.at_limit;
    }
    return out;
}

}  // namespace

FeelBuilder::FeelBuilder(const session::Header& header, std::span<const lesson::Event> events,
                         std::vector<Vec3> seats)
    : dt_(header.dt), seats_(std::move(seats)) {
    feel_.recorded = !header.servo.empty();
    feel_.obstacles = !header.obstacles.empty() && header.obstacles != "none";
    feel_.guided = header.guide.empty() ? header.mode == "guided" : header.guide == "on";
    feel_.device = session::limits_of(header.device);
    feel_.servo = header.servo;
    for (const lesson::Event& event : events)
        if (event.kind == "step_begin")
            steps_.push_back({event.tick, event.joint});
        else if (event.kind == "sight")
            sights_.push_back({event.tick, event.joint, event.value});
}

bool FeelBuilder::own_nut(collision::ObstacleId obstacle) const {
    if (!obstacle.is_nut()) return false;
    const auto joint = static_cast<int>(obstacle.index());
    return joint == due_ || joint == now_.last_joint;
}

void FeelBuilder::note_grip(double time, const session::TickRecord& tick) {
    const int held_before = before_ ? before_->joint : -1;
    if (tick.joint >= 0 && held_before < 0) taken_ = time;
    if (tick.joint < 0 && held_before >= 0) left_ = time;
    if (tick.joint >= 0) now_.last_joint = tick.joint;
    if (arrived_ || due_ < 0) return;
    const auto due = static_cast<std::size_t>(due_);
    if (due < seats_.size() && glm::length(vector_of(tick.device.position) - seats_[due]) < near_nut) {
        placing_ += dt_;
        if (sight_.joint != due_)
            seen_ = Moment::nan;
        else if (sight_.share >= in_sight)
            seen_ += dt_;
    }
    if (tick.joint != due_) return;
    arrived_ = true;
    const bool wrench = static_cast<servo::Grip>(tick.grip) == servo::Grip::wrench;
    feel_.arrivals.push_back({due_, wrench, time - step_begun_, placing_, seen_});
}

void FeelBuilder::note_touch(double time, const session::TickRecord& tick) {
    const bool touched_before = before_ && !before_->touched.is_none();
    const bool touches = !tick.touched.is_none();
    const bool free = tick.joint < 0;
    if (touches && !touched_before) {
        working_touch_ = !free;
        touch_ = time;
    }
    if (!touches && touched_before) lost_ = time;
    if (touches) now_.last_touched = tick.touched;
    const bool bumps = free && touches && !working_touch_ && !own_nut(tick.touched);
    if (!bumps) {
        in_bump_ = false;
        return;
    }
    std::vector<Bump>& all = feel_.bumps;
    const bool goes_on = in_bump_ || (!all.empty() && time - all.back().begin - all.back().length < one_bump);
    if (!goes_on) all.push_back({time, 0.0, tick.touched, 0.0});
    in_bump_ = true;
    all.back().length = time + dt_ - all.back().begin;
    all.back().hardest = std::max(all.back().hardest, glm::length(vector_of(tick.force)));
}

void FeelBuilder::keep_moment(const Moment& moment) {
    std::vector<Moment>& kept = feel_.moments;
    const auto same = std::find_if(kept.begin(), kept.end(),
                                   [&](const Moment& m) { return std::abs(m.time - moment.time) < apart; });
    if (same != kept.end()) {
        if (same->change >= moment.change) return;
        kept.erase(same);
    }
    const auto after =
        std::find_if(kept.begin(), kept.end(), [&](const Moment& m) { return m.change < moment.change; });
    kept.insert(after, moment);
    if (kept.size() > most_moments) kept.pop_back();
}

void FeelBuilder::note_change(double time, const session::TickRecord& tick) {
    if (!before_) return;
    const auto change = [&](const float(&now)[3], const float(&then)[3], std::vector<float>& all) {
        const Vec3 a = vector_of(now), b = vector_of(then);
        const double by = glm::length(a - b) * millisecond / dt_;
        const bool any = glm::dot(a, a) > 0.0 || glm::dot(b, b) > 0.0;
        if (any && std::isfinite(by)) all.push_back(static_cast<float>(by));
        return std::isfinite(by) ? by : 0.0;
    };
    (void)change(tick.torque, before_->torque, torque_changes_);
    const double by = change(tick.force, before_->force, force_changes_);
    const bool at_limit = feel_.device && by > feel_.device->force_rate * millisecond * (1.0 - rounding);
    const bool large = feel_.moments.size() < most_moments || by > feel_.moments.back().change;
    if (by <= 0.0 || !(large || at_limit)) return;
    Moment moment = now_;
    moment.time = time;
    moment.change = by;
    moment.tick = tick;
    moment.taken = since(time, taken_);
    moment.left = since(time, left_);
    moment.touched = since(time, touch_);
    moment.lost_touch = since(time, lost_);
    if (at_limit) ++feel_.at_limit[static_cast<std::size_t>(doing(moment))];
    if (large) keep_moment(moment);
}

void FeelBuilder::take(std::uint64_t number, const session::TickRecord& tick) {
    const double time = static_cast<double>(number) * dt_;
    while (next_step_ < steps_.size() && steps_[next_step_].tick <= number) {
        due_ = steps_[next_step_++].joint;
        arrived_ = false;
        step_begun_ = time;
        placing_ = seen_ = 0.0;
    }
    while (next_sight_ < sights_.size() && sights_[next_sight_].tick <= number)
        sight_ = sights_[next_sight_++];
    note_grip(time, tick);
    note_touch(time, tick);
    note_change(time, tick);
    feel_.faults[tick.fault] += dt_;
    before_ = tick;
}

void FeelBuilder::add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks) {
    for (std::size_t i = 0; i < ticks.size(); ++i) take(first_tick + i, ticks[i]);
}

Feel FeelBuilder::finish() {
    const force::OutputLimits none{.force = 0.0, .torque = 0.0, .force_rate = 0.0, .torque_rate = 0.0};
    const force::OutputLimits limits = feel_.device.value_or(none);
    feel_.force = summed_up(force_changes_, limits.force, limits.force_rate * millisecond);
    feel_.torque = summed_up(torque_changes_, limits.torque, limits.torque_rate * millisecond);
    feel_.faults[0] = 0.0;
    return std::move(feel_);
}

std::string obstacle_text(collision::ObstacleId id, const std::vector<session::ObstacleName>& obstacles) {
    const auto found = std::find_if(obstacles.begin(), obstacles.end(),
                                    [&](const session::ObstacleName& o) { return o.id == id; });
    return found != obstacles.end() ? found->name
                                    : fmt::format("{} {}", id.is_nut() ? "nut" : "obstacle", id.index());
}

Doing doing(const Moment& m) {
    if (m.tick.fault != 0) return Doing::held_off;
    if (m.tick.joint < 0 && m.left <= just_now) return Doing::leaving;
    if (m.tick.joint >= 0) return m.taken <= just_now ? Doing::taking : Doing::on_nut;
    return !m.tick.touched.is_none() || m.lost_touch <= just_now ? Doing::against : Doing::free;
}

std::string happening(const Moment& m, const std::vector<lesson::JointResult>& joints,
                      const std::vector<session::ObstacleName>& obstacles) {
    const auto joint = [&](int j) {
        return j >= 0 && static_cast<std::size_t>(j) < joints.size() ? joints[static_cast<std::size_t>(j)].id
                                                                     : fmt::format("joint {}", j);
    };
    const char* const tool =
        static_cast<servo::Grip>(m.tick.grip) == servo::Grip::fingers ? "fingers" : "wrench";
    const bool touches = !m.tick.touched.is_none();
    std::string text;
    switch (doing(m)) {
        case Doing::held_off:
            return fmt::format("the output was held off: {}",
                               force::name(static_cast<force::Fault>(m.tick.fault)));
        case Doing::leaving:
            text = fmt::format("the hand lets go of {}", joint(m.last_joint));
            break;
        case Doing::taking:
            text = fmt::format("{} taking hold of {}", tool, joint(m.tick.joint));
            break;
        case Doing::on_nut:
            text = fmt::format("{} on {}, {}, {:.1f} N·m", tool, joint(m.tick.joint),
                               joint::name(static_cast<joint::Stage>(m.tick.stage)),
                               static_cast<double>(m.tick.wrench_torque));
            break;
        case Doing::against:
        case Doing::free:
            text = m.tick.guide >= 0 ? fmt::format("led to {}", joint(m.tick.guide)) : "in the air";
            break;
    }
    if (m.touched <= just_now && touches)
        text += ", meeting " + obstacle_text(m.tick.touched, obstacles);
    else if (m.lost_touch <= just_now && !touches)
        text += ", coming off " + obstacle_text(m.last_touched, obstacles);
    else if (touches)
        text += ", against " + obstacle_text(m.tick.touched, obstacles);
    return text;
}

}  // namespace bolt::analysis
