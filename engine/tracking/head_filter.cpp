#include "engine/tracking/head_filter.hpp"

#include <algorithm>

namespace bolt::tracking {

namespace {

// Returns `from` for the fraction 0, `to` for 1.
Pose interpolate(const Pose& from, const Pose& to, double fraction) {
    return {glm::mix(from.position, to.position, fraction),
            glm::normalize(glm::slerp(from.orientation, to.orientation, fraction))};
}

// Returns true if a head can move from one sample to the other.
bool is_reachable(const HeadFilterSettings& settings, const HeadSample& from, const HeadSample& to) {
    const double duration = to.time - from.time;
    const double distance = glm::length(to.pose.position - from.pose.position);
    const double turn = glm::length(turn_between(from.pose.orientation, to.pose.orientation));
    return distance <= jump_slack + settings.max_speed * duration &&
           turn <= turn_slack + settings.max_turn * duration;
}

bool is_usable(const HeadFilterState& state, const HeadSample& sample) {
    const Quat& q = sample.pose.orientation;
    const bool is_finite =
        std::isfinite(sample.time) && finite(sample.pose.position) && std::abs(glm::length(q) - 1.0) < 1e-3;
    const auto is_newer = [&](const std::optional<HeadSample>& than) {
        return !than || sample.time > than->time;
    };
    return is_finite && is_newer(state.accepted) && is_newer(state.jump_end);
}

void accept(HeadFilterState& state, const HeadSample& sample, bool is_return, double now) {
    if (is_return && state.shown) state.return_from = HeadSample{now, state.shown->pose};
    state.accepted = sample;
    state.jump_start = state.jump_end = std::nullopt;
}

void add_sample(HeadFilterState& state, const HeadFilterSettings& settings, const HeadSample& sample,
                double now) {
    if (!is_usable(state, sample)) return;
    if (!state.accepted || is_reachable(settings, *state.accepted, sample)) {
        const bool was_lost = !state.accepted || sample.time - state.accepted->time > max_sample_age;
        // The jump is accepted: by now a head could have moved this far since the accepted sample.
        const bool ends_jump = state.jump_end && is_reachable(settings, *state.jump_end, sample);
        accept(state, sample, was_lost || ends_jump, now);
        return;
    }
    const bool continues_jump = state.jump_end && sample.time - state.jump_end->time <= max_sample_age &&
                                is_reachable(settings, *state.jump_end, sample);
    if (!continues_jump) state.jump_start = sample;
    state.jump_end = sample;
    if (sample.time - state.jump_start->time >= settings.jump_time) accept(state, sample, true, now);
}

// The head as the accepted sample gives it.
FilteredHead target_at(const HeadFilterState& state, const HeadFilterSettings& settings, double now) {
    if (!state.accepted) return {settings.fixed_head, HeadStatus::faded};
    const Pose& last = state.accepted->pose;
    const double age = now - state.accepted->time,
                 dropout_time = std::max(settings.dropout_time, max_sample_age);
    if (age <= max_sample_age) return {last, HeadStatus::tracked};
    if (age <= dropout_time) return {last, HeadStatus::held};
    const double fraction =
        settings.fade_time > 0.0 ? minimum_jerk((age - dropout_time) / settings.fade_time) : 1.0;
    return {interpolate(last, settings.fixed_head, fraction), HeadStatus::faded};
}

}  // namespace

FilteredHead filter_head(HeadFilterState& state, const HeadFilterSettings& settings,
                         std::span<const HeadSample> samples, double now) {
    for (const HeadSample& sample : samples) add_sample(state, settings, sample, now);
    FilteredHead head = target_at(state, settings, now);
    if (state.return_from) {
        const double passed = now - state.return_from->time;
        if (passed < settings.return_time)
            head.pose =
                interpolate(state.return_from->pose, head.pose, minimum_jerk(passed / settings.return_time));
        else
            state.return_from.reset();
    }
    state.shown = head;
    return head;
}

}  // namespace bolt::tracking
