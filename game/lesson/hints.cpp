#include "game/lesson/hints.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::lesson {

namespace {

using words::Key;

struct Row {
    Situation situation;
    Key text;
    Motion motion;
};

// In the order of the situations.
constexpr Row rows[] = {
    {Situation::take_wrench, "hint.take_wrench", Motion::take},
    {Situation::put_wrench_away, "hint.put_wrench_away", Motion::put_away},
    {Situation::find_by_wrench, "hint.find_by_wrench", Motion::approach},
    {Situation::find_by_fingers, "hint.find_by_fingers", Motion::reach},
    {Situation::set_on, "hint.set_on", Motion::set_on},
    {Situation::set_on_again, "hint.set_on_again", Motion::set_on},
    {Situation::set_on_rounded, "hint.set_on_rounded", Motion::set_on},
    {Situation::grip_nut, "hint.grip_nut", Motion::grip_nut},
    {Situation::run_down, "hint.run_down", Motion::spin},
    {Situation::run_down_by_wrench, "hint.run_down_by_wrench", Motion::pull_on},
    {Situation::twist_back, "hint.twist_back", Motion::twist_back},
    {Situation::seated, "hint.seated", Motion::lift},
    {Situation::pull, "hint.pull", Motion::pull_on},
    {Situation::pull_to_yield, "hint.pull_to_yield", Motion::pull_on},
    {Situation::pull_to_click, "hint.pull_to_click", Motion::pull_on},
    {Situation::set_back, "hint.set_back", Motion::set_back},
    {Situation::ease, "hint.ease", Motion::pull_on},
    {Situation::ease_to_yield, "hint.ease_to_yield", Motion::pull_on},
    {Situation::stop, "hint.stop", Motion::lift},
    {Situation::stop_at_yield, "hint.stop_at_yield", Motion::lift},
    {Situation::stop_at_click, "hint.stop_at_click", Motion::lift},
    {Situation::stop_too_much, "hint.stop_too_much", Motion::lift},
    {Situation::take_off, "hint.take_off", Motion::lift},
    {Situation::check, "hint.check", Motion::pull_on},
    {Situation::checked, "hint.checked", Motion::lift},
    {Situation::break_loose, "hint.break_loose", Motion::pull_off},
    {Situation::turn_off, "hint.turn_off", Motion::pull_off},
    {Situation::free, "hint.free", Motion::lift},
    {Situation::wrong_joint, "hint.wrong_joint", Motion::lift},
    {Situation::other_way_on, "hint.other_way_on", Motion::pull_on},
    {Situation::other_way_off, "hint.other_way_off", Motion::pull_off},
    {Situation::wrench_needed, "hint.wrench_needed", Motion::let_go},
    {Situation::leave_broken, "hint.leave_broken", Motion::lift},
    {Situation::leave_stripped, "hint.leave_stripped", Motion::lift},
    {Situation::next, "hint.next", Motion::approach},
    {Situation::round_run_down, "hint.round_run_down", Motion::reach},
    {Situation::round_tighten, "hint.round_tighten", Motion::approach},
    {Situation::round_recheck, "hint.round_recheck", Motion::approach},
    {Situation::round_loosen, "hint.round_loosen", Motion::approach},
    {Situation::all_done, "hint.all_done", Motion::none},
};
static_assert(std::size(rows) == situation_count);
static_assert([] {
    for (std::size_t i = 0; i < situation_count; ++i)
        if (rows[i].situation != static_cast<Situation>(i)) return false;
    return true;
}());

// In the order of the motions; none has none.
constexpr Key motion_keys[] = {
    "how.take",    "how.take",     "how.put_away", "how.approach",   "how.reach",
    "how.set_on",  "how.grip_nut", "how.spin",     "how.twist_back", "how.let_go",
    "how.pull_on", "how.pull_off", "how.lift",     "how.set_back",
};
static_assert(std::size(motion_keys) == motion_count);

const Row& row(Situation situation) { return rows[static_cast<std::size_t>(situation)]; }

// The same motion is another with fingers.
Motion by_hand(Motion motion, const Scene& scene) {
    if (held(scene) != Held::nut_by_fingers) return motion;
    if (motion == Motion::lift) return Motion::let_go;
    return motion == Motion::pull_on ? Motion::spin : motion;
}

std::vector<words::Place> places(const Scene& scene) {
    const lesson::Step* due = scene.lesson.due();
    if (due == nullptr) return {};
    const auto& joints = scene.lesson.assembly->joints;
    const content::Window window = lesson::window(scene.lesson, *due);
    std::vector<words::Place> filled{
        {"joint", joints[due->joint].design.id},
        {"size", words::Number{1e3 * scene.setup.nuts[due->joint].across_flats, 0}},
        {"percent", words::Number{100.0 * due->fraction, 0}},
        {"torque", words::torque_number(due->torque)},
        {"low", words::torque_number(window.low)},
        {"high", words::torque_number(window.high)},
        {"most", words::torque_number(window.high)},
    };
    if (scene.lesson.held >= 0)
        filled.push_back({"held", joints[static_cast<std::size_t>(scene.lesson.held)].design.id});
    return filled;
}

}  // namespace

Ghost Hint::ghost() const {
    if (level < 2) return Ghost::none;
    switch (motion) {
        case Motion::none:
            return Ghost::none;
        case Motion::take:
        case Motion::reach:
        case Motion::grip_nut:
        case Motion::spin:
        case Motion::twist_back:
        case Motion::let_go:
            return Ghost::hand;
        default:
            return Ghost::hand_and_wrench;
    }
}

Hint make_hint(Situation situation, Situation then, int level, const Scene& scene) {
    const lesson::Step* due = scene.lesson.due();
    Hint hint;
    hint.situation = situation;
    hint.level = due == nullptr ? 0 : level;
    hint.joint = due == nullptr ? -1 : static_cast<int>(due->joint);
    hint.motion = by_hand(row(then).motion, scene);
    hint.text = row(situation).text;
    hint.places = places(scene);
    return hint;
}

std::string say(const words::Words& words, const Hint& hint) {
    return words::say(words, hint.text, hint.places);
}

std::string say_motion(const words::Words& words, const Hint& hint, const Controls& controls) {
    if (hint.level < 3 || hint.motion == Motion::none) return {};
    const auto motion = static_cast<std::size_t>(hint.motion);
    return words::say(words, motion_keys[motion], {{"control", controls[motion]}});
}

namespace {

using words::Key;

struct ControlRow {
    Motion motion;
    Key mouse, device;
};
constexpr ControlRow control_rows[] = {
    {Motion::take, "control.mouse.take", "control.device.take"},
    {Motion::put_away, "control.mouse.put_away", "control.device.put_away"},
    {Motion::approach, "control.mouse.go", "control.device.move"},
    {Motion::reach, "control.mouse.go", "control.device.move"},
    {Motion::set_on, "control.mouse.go", "control.device.move"},
    {Motion::grip_nut, "control.mouse.go", "control.device.grip"},
    {Motion::spin, "control.mouse.spin", "control.device.turn"},
    {Motion::twist_back, "control.mouse.again", "control.device.twist_back"},
    {Motion::let_go, "control.mouse.let_go", "control.device.release"},
    {Motion::pull_on, "control.mouse.pull", "control.device.turn"},
    {Motion::pull_off, "control.mouse.pull", "control.device.turn"},
    {Motion::lift, "control.mouse.let_go", "control.device.move"},
    {Motion::set_back, "control.mouse.again", "control.device.move"},
};
static_assert(std::size(control_rows) == motion_count - 1);  // all but none

std::string& at(Controls& controls, Motion motion) { return controls.at(static_cast<std::size_t>(motion)); }

Controls controls(const words::Words& words, Key ControlRow::*of, const std::string& key) {
    Controls said;
    for (const ControlRow& row : control_rows)
        at(said, row.motion) = words::say(words, row.*of, {{"key", key}});
    return said;
}

}  // namespace

Controls mouse_controls(const words::Words& words, const std::string& tool_key) {
    return controls(words, &ControlRow::mouse, tool_key);
}

Controls device_controls(const words::Words& words, const std::string& button, const std::string& tool_key) {
    Controls said = controls(words, &ControlRow::device, button);
    at(said, Motion::put_away) = words::say(words, "control.device.put_away", {{"key", tool_key}});
    return said;
}

namespace {

Controls pushed(const words::Words& words, const std::string& button, const std::string& tool_key, Key move,
                Key turn) {
    Controls said = device_controls(words, button, tool_key);
    for (const Motion motion : {Motion::approach, Motion::reach, Motion::set_on})
        at(said, motion) = words::say(words, move, {{"key", button}});
    for (const Motion motion : {Motion::spin, Motion::pull_on, Motion::pull_off})
        at(said, motion) = words::say(words, turn, {});
    return said;
}

}  // namespace

Controls puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key) {
    return pushed(words, button, tool_key, "control.puck.move", "control.device.turn");
}

Controls keyboard_controls(const words::Words& words, const std::string& button,
                           const std::string& tool_key) {
    return pushed(words, button, tool_key, "control.keys.move", "control.keys.turn");
}

namespace {

struct ByFingers {
    Motion motion;
    Key said;
};
constexpr ByFingers finger_controls[] = {{Motion::take, "control.glove.take"},
                                         {Motion::put_away, "control.glove.put_away"},
                                         {Motion::grip_nut, "control.glove.grip"},
                                         {Motion::twist_back, "control.glove.twist_back"},
                                         {Motion::let_go, "control.glove.release"}};

}  // namespace

Controls glove_controls(const words::Words& words, Controls moved_by) {
    for (const ByFingers& row : finger_controls) at(moved_by, row.motion) = words::say(words, row.said, {});
    return moved_by;
}

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
