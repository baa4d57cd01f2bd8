#include "game/lesson/hints.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::lesson {

namespace {

constexpr double announced_for = 3.0;   // s
constexpr double certain_after = 0.15;  // s that something is so before it is believed
constexpr double between_after = 1.0;   // s that a hand is off the nut before it is more than a stroke's end
constexpr double adrift_after = 3.0;    // s in which all changes all the time: then any of it is said
constexpr double more_torque = 0.02;    // of it, and
constexpr double some_torque = 0.05;    // N·m: progress
constexpr double some_angle = to_radians(1.0);
constexpr double some_way = 0.02;  // m
constexpr int most_level = 3;

// What cannot wait: the torque grows as long as nothing is said.
bool at_once(Situation s) {
    return s == Situation::stop || s == Situation::stop_at_yield || s == Situation::stop_at_click ||
           s == Situation::stop_too_much || s == Situation::leave_broken || s == Situation::leave_stripped;
}

bool urgent(Situation s) {
    return at_once(s) || s == Situation::wrong_joint || s == Situation::other_way_on ||
           s == Situation::other_way_off || s == Situation::seated || s == Situation::checked ||
           s == Situation::all_done;
}

bool on_the_way(Situation s) {
    return s == Situation::take_wrench || s == Situation::put_wrench_away || s == Situation::find_by_wrench ||
           s == Situation::find_by_fingers;
}

Situation announcement(const lesson::Step& step, bool new_round) {
    if (!new_round) return Situation::next;
    switch (step.kind) {
        case lesson::StepKind::run_down:
            return Situation::round_run_down;
        case lesson::StepKind::tighten:
            return Situation::round_tighten;
        case lesson::StepKind::recheck:
            return Situation::round_recheck;
        case lesson::StepKind::loosen:
            return Situation::round_loosen;
    }
    return Situation::next;
}

// Torque and angle first: when the nut has moved on, coming back to it for the next stroke is progress too.
void note_progress(Progress& progress, const Scene& scene, Situation now, double dt) {
    progress.idle += dt;
    const lesson::Step* due = scene.lesson.due();
    if (due == nullptr) return;
    const lesson::JointTrack& track = scene.lesson.joints[due->joint];
    const double sense = due->kind == lesson::StepKind::loosen ? -1.0 : 1.0;
    const double angle = sense * (world::joint_at(scene.world, due->joint).angle - track.begin_angle);
    const bool torque = track.peak_torque > (1.0 + more_torque) * progress.torque + some_torque;
    if (torque || angle > progress.angle + some_angle) {
        progress.torque = std::max(progress.torque, track.peak_torque);
        progress.angle = std::max(progress.angle, angle);
        progress.moved = true;
        progress.idle = 0.0;
    }
    if (progress.moved && scene.lesson.held < 0) {
        progress.moved = false;
        progress.distance = 1e9;
        progress.reached = 0;
    }
    const bool tool = now != Situation::take_wrench && now != Situation::put_wrench_away &&
                      now != Situation::wrong_joint && now != Situation::wrench_needed;
    const int reached = scene.lesson.held == static_cast<int>(due->joint) ? 2 : tool ? 1 : 0;
    if (reached > progress.reached) {
        progress.reached = reached;
        progress.idle = 0.0;
    }
    const double distance = distance_to_due(scene);
    if (tool && distance < progress.distance - some_way) {
        progress.distance = distance;
        progress.idle = 0.0;
    }
}

void begin_step(Hints& hints, const Scene& scene) {
    const lesson::Step* due = scene.lesson.due();
    hints.step = scene.lesson.current;
    hints.step_for = 0.0;
    hints.progress = {};
    hints.new_round = due != nullptr && due->pass != hints.pass;
    if (due != nullptr) hints.pass = due->pass;
}

// 0 on the way to the nut, 1 at work on it, 2 at its end.
int phase(Situation s) {
    switch (s) {
        case Situation::run_down:
        case Situation::run_down_by_wrench:
        case Situation::pull:
        case Situation::pull_to_yield:
        case Situation::pull_to_click:
        case Situation::check:
        case Situation::break_loose:
        case Situation::turn_off:
            return 1;
        case Situation::ease:
        case Situation::ease_to_yield:
            return 2;
        default:
            return 0;
    }
}

bool between_strokes(Situation s) {
    return s == Situation::grip_nut || s == Situation::set_on_again || s == Situation::set_on_rounded;
}

// Whether what is seen now takes the place of what is said. Who has got on need not read to the end how to.
bool replaces(const Hints& hints, Situation seen) {
    if (seen == hints.situation) return false;
    if (!hints.shown || at_once(seen)) return true;
    if (hints.other_for >= adrift_after) return true;
    const bool paused = phase(hints.situation) > 0 && between_strokes(seen);
    if (hints.seen_for < (paused ? between_after : certain_after)) return false;
    const bool got_on = phase(seen) > phase(hints.situation);
    return urgent(seen) || hints.stands >= (got_on ? shortest_when_past : shortest_hint);
}

int level_by_time(const HintTimes& times, double idle) {
    const auto reached =
        std::count_if(times.level.begin(), times.level.end(), [&](double from) { return idle >= from; });
    return static_cast<int>(reached) - 1;
}

}  // namespace

const std::optional<Hint>& update(Hints& hints, const Scene& scene, double dt, bool asked) {
    if (scene.lesson.mode == lesson::Mode::assessment) {
        hints = {};
        return hints.shown;
    }
    hints.stands += dt;
    hints.step_for += dt;
    const bool other_step = hints.step != scene.lesson.current;
    if (other_step) begin_step(hints, scene);
    const Situation then = situation(scene);
    note_progress(hints.progress, scene, then, dt);

    const lesson::Step* due = scene.lesson.due();
    const bool announces = due != nullptr && on_the_way(then) && hints.step_for < announced_for;
    const Situation seen = announces ? announcement(*due, hints.new_round) : then;
    hints.seen_for = seen == hints.seen ? hints.seen_for + dt : 0.0;
    hints.other_for = seen == hints.situation ? 0.0 : hints.other_for + dt;
    hints.seen = seen;
    bool other = false;
    if (other_step || replaces(hints, seen)) {
        hints.situation = seen;
        hints.stands = hints.other_for = 0.0;
        hints.level = -1;
        other = true;
    }

    const bool guided = scene.lesson.mode == lesson::Mode::guided;
    int level =
        std::max(hints.level, level_by_time(guided ? guided_times : practice_times, hints.progress.idle));
    if (asked) level = std::min(level + 1, most_level);
    // The same may be said of another joint in the hand, or lead to another motion; what only goes on being
    // said for a while keeps its words.
    other = other || (seen == hints.situation && (scene.lesson.held != hints.held || then != hints.then));
    hints.level = level;
    if (level < 0) {
        hints.shown.reset();
    } else if (other || !hints.shown) {
        if (!hints.shown) hints.stands = 0.0;
        hints.held = scene.lesson.held;
        hints.then = then;
        hints.shown = make_hint(hints.situation, then, level, scene);
    } else {
        hints.shown->level = hints.shown->joint < 0 ? 0 : level;
    }
    return hints.shown;
}

}  // namespace bolt::lesson
