#include "game/lesson/hints.hpp"

#include <algorithm>
#include <cmath>

#include "game/lesson/fastener_names.hpp"
#include "game/lesson/step_requirements.hpp"

namespace bolt::lesson {

namespace {

using words::TextKey;

struct HintRow {
    Situation situation;
    TextKey text;
    HintMotion motion;
};

// In the order of the situations.
constexpr HintRow hint_rows[] = {
    {Situation::take_wrench, "hint.take_wrench", HintMotion::take},
    {Situation::put_wrench_away, "hint.put_wrench_away", HintMotion::put_away},
    {Situation::find_by_wrench, "hint.find_by_wrench", HintMotion::approach},
    {Situation::find_by_fingers, "hint.find_by_fingers", HintMotion::reach},
    {Situation::set_on, "hint.set_on", HintMotion::set_on},
    {Situation::set_on_again, "hint.set_on_again", HintMotion::set_on},
    {Situation::set_on_rounded, "hint.set_on_rounded", HintMotion::set_on},
    {Situation::counter_hold, "hint.hold_held_part", HintMotion::counter_hold},
    {Situation::grip_nut, "hint.grip_nut", HintMotion::grip_nut},
    {Situation::run_down, "hint.run_down", HintMotion::spin},
    {Situation::run_down_by_wrench, "hint.run_down_by_wrench", HintMotion::pull_on},
    {Situation::twist_back, "hint.twist_back", HintMotion::twist_back},
    {Situation::seated, "hint.seated", HintMotion::lift},
    {Situation::pull, "hint.pull", HintMotion::pull_on},
    {Situation::pull_to_yield, "hint.pull_to_yield", HintMotion::pull_on},
    {Situation::pull_to_click, "hint.pull_to_click", HintMotion::pull_on},
    {Situation::pull_to_click_by_adaptor, "hint.pull_to_click_by_adaptor", HintMotion::pull_on},
    {Situation::turn_on, "hint.turn_on", HintMotion::pull_on},
    {Situation::set_back, "hint.set_back", HintMotion::set_back},
    {Situation::ease, "hint.ease", HintMotion::pull_on},
    {Situation::ease_to_yield, "hint.ease_to_yield", HintMotion::pull_on},
    {Situation::ease_to_angle, "hint.ease_to_angle", HintMotion::pull_on},
    {Situation::stop, "hint.stop", HintMotion::lift},
    {Situation::stop_at_yield, "hint.stop_at_yield", HintMotion::lift},
    {Situation::stop_at_click, "hint.stop_at_click", HintMotion::lift},
    {Situation::stop_too_much, "hint.stop_too_much", HintMotion::lift},
    {Situation::stop_at_angle, "hint.stop_at_angle", HintMotion::lift},
    {Situation::stop_too_far, "hint.stop_too_far", HintMotion::lift},
    {Situation::take_off, "hint.take_off", HintMotion::lift},
    {Situation::check, "hint.check", HintMotion::pull_on},
    {Situation::checked, "hint.checked", HintMotion::lift},
    {Situation::break_loose, "hint.break_loose", HintMotion::pull_off},
    {Situation::unscrew, "hint.turn_off", HintMotion::pull_off},
    {Situation::turn_back, "hint.turn_back", HintMotion::pull_off},
    {Situation::turned_back, "hint.turned_back", HintMotion::lift},
    {Situation::free, "hint.free", HintMotion::lift},
    {Situation::wrong_joint, "hint.wrong_joint", HintMotion::lift},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on},
    {Situation::other_way_off, "hint.other_way_off", HintMotion::pull_off},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go},
    {Situation::leave_broken, "hint.leave_broken", HintMotion::lift},
    {Situation::leave_stripped, "hint.leave_stripped", HintMotion::lift},
    {Situation::next, "hint.next", HintMotion::approach},
    {Situation::pass_run_down, "hint.pass_run_down", HintMotion::reach},
    {Situation::pass_tighten, "hint.pass_tighten", HintMotion::approach},
    {Situation::pass_turn, "hint.pass_turn", HintMotion::approach},
    {Situation::pass_recheck, "hint.pass_recheck", HintMotion::approach},
    {Situation::pass_turn_back, "hint.pass_turn_back", HintMotion::approach},
    {Situation::pass_loosen, "hint.pass_loosen", HintMotion::approach},
    {Situation::all_done, "hint.all_done", HintMotion::none},
};
static_assert(std::size(hint_rows) == situation_count);
static_assert([] {
    for (std::size_t i = 0; i < situation_count; ++i)
        if (hint_rows[i].situation != static_cast<Situation>(i)) return false;
    return true;
}());

// In the order of the motions. The entry of `none` is not used.
constexpr TextKey motion_keys[] = {
    "how.take",    "how.take",     "how.put_away", "how.approach",   "how.reach",
    "how.set_on",  "how.grip_nut", "how.spin",     "how.twist_back", "how.let_go",
    "how.pull_on", "how.pull_off", "how.lift",     "how.set_back",   "how.hold",
};
static_assert(std::size(motion_keys) == motion_count);

const HintRow& row(Situation situation) { return hint_rows[static_cast<std::size_t>(situation)]; }

// The hand motion that replaces `motion` if the fingers hold the nut.
HintMotion adapt_to_grip(HintMotion motion, const ObservedLesson& work) {
    if (held_item(work) != HeldItem::nut_by_fingers) return motion;
    if (motion == HintMotion::lift) return HintMotion::let_go;
    return motion == HintMotion::pull_on ? HintMotion::spin : motion;
}

std::vector<words::TextArgument> text_arguments(const ObservedLesson& work) {
    const LessonStep* due = work.lesson.due();
    const auto& joints = work.lesson.assembly->joints;
    if (due == nullptr) return {fasteners_argument(*work.lesson.assembly)};
    const content::ToleranceWindow window = torque_window(work.lesson, *due);
    std::vector<words::TextArgument> arguments{
        {"joint", joints[due->joint].design.id},
        fastener_argument(joints[due->joint].design),
        fasteners_argument(*work.lesson.assembly),
        thread_argument(joints[due->joint].design),
        {"size", words::Number{1e3 * work.setup.nuts[due->joint].across_flats, 0}},
        {"percent", words::Number{100.0 * due->fraction, 0}},
        {"torque", words::torque_number(due->torque)},
        {"scale", words::torque_number(wrench_set_torque(work.lesson))},
        {"low", words::torque_number(window.low)},
        {"high", words::torque_number(window.high)},
        {"most", words::torque_number(window.high)},
        {"angle", words::Number{to_degrees(due->angle), 0}},
        {"most_angle", words::Number{to_degrees(angle_window(*work.lesson.assembly, *due).high), 0}},
    };
    if (work.lesson.held_joint >= 0)
        arguments.push_back({"held", joints[static_cast<std::size_t>(work.lesson.held_joint)].design.id});
    return arguments;
}

}  // namespace

GhostKind Hint::ghost() const {
    if (level < 2) return GhostKind::none;
    switch (motion) {
        case HintMotion::none:
        case HintMotion::counter_hold:
            return GhostKind::none;
        case HintMotion::take:
        case HintMotion::reach:
        case HintMotion::grip_nut:
        case HintMotion::spin:
        case HintMotion::twist_back:
        case HintMotion::let_go:
            return GhostKind::hand;
        default:
            return GhostKind::hand_and_wrench;
    }
}

Hint make_hint(Situation situation, Situation underlying, int level, const ObservedLesson& work) {
    const LessonStep* due = work.lesson.due();
    Hint hint;
    hint.situation = situation;
    hint.level = due == nullptr ? 0 : level;
    hint.joint = due == nullptr ? -1 : static_cast<int>(due->joint);
    hint.motion = adapt_to_grip(row(underlying).motion, work);
    hint.text = row(situation).text;
    hint.arguments = text_arguments(work);
    return hint;
}

std::string hint_text(const words::Words& words, const Hint& hint) {
    return words::format_text(words, hint.text, hint.arguments);
}

std::string motion_text(const words::Words& words, const Hint& hint, const ControlNames& controls) {
    if (hint.level < 3 || hint.motion == HintMotion::none) return {};
    const auto motion = static_cast<std::size_t>(hint.motion);
    std::vector<words::TextArgument> arguments = hint.arguments;
    arguments.push_back({"control", words::replace_placeholders(words, controls[motion], hint.arguments)});
    return words::format_text(words, motion_keys[motion], arguments);
}

namespace {

constexpr double announcement_duration = 3.0;  // s
constexpr double debounce = 0.15;              // s for which a situation must last before it is shown
constexpr double stroke_debounce = 1.0;        // s, the same between the strokes on a nut
constexpr double unstable_after = 3.0;         // s of changing situations after which the latest is shown
// Increments that count as progress. Torque: 2 % of the best torque plus 0.05 N·m.
constexpr double relative_torque_step = 0.02, torque_step = 0.05;  // N·m
constexpr double angle_step = to_radians(1.0);
constexpr double distance_step = 0.02;  // m
constexpr int max_level = 3;

// Hints that are shown immediately, because the torque keeps rising until the trainee reads them.
bool immediate(Situation s) {
    return s == Situation::stop || s == Situation::stop_at_yield || s == Situation::stop_at_click ||
           s == Situation::stop_too_much || s == Situation::stop_at_angle || s == Situation::stop_too_far ||
           s == Situation::leave_broken || s == Situation::leave_stripped;
}

// Hints that replace another one before its minimum duration.
bool urgent(Situation s) {
    return immediate(s) || s == Situation::wrong_joint || s == Situation::other_way_on ||
           s == Situation::other_way_off || s == Situation::seated || s == Situation::checked ||
           s == Situation::all_done;
}

// Situations in which the hand moves to the nut; the announcement of the step may replace their hints.
bool on_the_way(Situation s) {
    return s == Situation::take_wrench || s == Situation::put_wrench_away || s == Situation::find_by_wrench ||
           s == Situation::find_by_fingers;
}

Situation announcement(const LessonStep& step, bool new_pass) {
    if (!new_pass) return Situation::next;
    switch (step.kind) {
        case StepKind::run_down:
            return Situation::pass_run_down;
        case StepKind::tighten:
            return Situation::pass_tighten;
        case StepKind::turn:
            return Situation::pass_turn;
        case StepKind::recheck:
            return Situation::pass_recheck;
        case StepKind::loosen:
            return step.angle > 0.0 ? Situation::pass_turn_back : Situation::pass_loosen;
    }
    return Situation::next;
}

// Updates torque and angle first: after the nut has moved, returning to it for the next stroke is progress
// too.
void update_progress(StepProgress& progress, const ObservedLesson& work, Situation now, double dt) {
    progress.idle += dt;
    const LessonStep* due = work.lesson.due();
    if (due == nullptr) return;
    const JointTrack& track = work.lesson.joints[due->joint];
    const double sense = due->kind == StepKind::loosen ? -1.0 : 1.0;
    const double angle = sense * (world::joint_at(work.world, due->joint).angle - track.begin_angle);
    const bool torque = track.peak_torque > (1.0 + relative_torque_step) * progress.torque + torque_step;
    if (torque || angle > progress.angle + angle_step) {
        progress.torque = std::max(progress.torque, track.peak_torque);
        progress.angle = std::max(progress.angle, angle);
        progress.moved = true;
        progress.idle = 0.0;
    }
    if (progress.moved && work.lesson.held_joint < 0) {
        progress.moved = false;
        progress.distance = 1e9;
        progress.reached = Reached::nothing;
    }
    const bool tool = now != Situation::take_wrench && now != Situation::put_wrench_away &&
                      now != Situation::wrong_joint && now != Situation::wrench_needed;
    const Reached reached = work.lesson.held_joint == static_cast<int>(due->joint) ? Reached::tool_on_nut
                            : tool                                                 ? Reached::right_tool
                                                                                   : Reached::nothing;
    if (reached > progress.reached) {
        progress.reached = reached;
        progress.idle = 0.0;
    }
    const double distance = distance_to_due(work);
    if (tool && distance < progress.distance - distance_step) {
        progress.distance = distance;
        progress.idle = 0.0;
    }
}

void begin_step(HintState& hints, const ObservedLesson& work) {
    const LessonStep* due = work.lesson.due();
    hints.step = work.lesson.current;
    hints.step_time = 0.0;
    hints.progress = {};
    hints.new_pass = due != nullptr && due->pass != hints.pass;
    if (due != nullptr) hints.pass = due->pass;
}

enum class WorkPhase : std::uint8_t { approach, work, end_of_work };

WorkPhase phase(Situation s) {
    switch (s) {
        case Situation::run_down:
        case Situation::run_down_by_wrench:
        case Situation::pull:
        case Situation::pull_to_yield:
        case Situation::pull_to_click:
        case Situation::pull_to_click_by_adaptor:
        case Situation::check:
        case Situation::turn_on:
        case Situation::break_loose:
        case Situation::unscrew:
        case Situation::turn_back:
            return WorkPhase::work;
        case Situation::ease:
        case Situation::ease_to_yield:
        case Situation::ease_to_angle:
            return WorkPhase::end_of_work;
        default:
            return WorkPhase::approach;
    }
}

bool between_strokes(Situation s) {
    return s == Situation::grip_nut || s == Situation::set_on_again || s == Situation::set_on_rounded;
}

// True if the hint for `candidate` replaces the shown one. A trainee who has advanced to the next phase need
// not finish reading the old hint.
bool replaces(const HintState& hints, Situation candidate) {
    if (candidate == hints.shown_situation) return false;
    if (!hints.shown || immediate(candidate)) return true;
    if (hints.differs_for >= unstable_after) return true;
    const bool paused = phase(hints.shown_situation) > WorkPhase::approach && between_strokes(candidate);
    if (hints.candidate_for < (paused ? stroke_debounce : debounce)) return false;
    const bool advanced = phase(candidate) > phase(hints.shown_situation);
    return urgent(candidate) ||
           hints.shown_for >= (advanced ? min_duration_when_fulfilled : min_hint_duration);
}

int level_by_time(const HintTimes& times, double idle) {
    const auto reached =
        std::count_if(times.level.begin(), times.level.end(), [&](double from) { return idle >= from; });
    return static_cast<int>(reached) - 1;
}

}  // namespace

const std::optional<Hint>& update(HintState& hints, const ObservedLesson& work, double dt, bool requested) {
    if (work.lesson.mode == Mode::assessment) {
        hints = {};
        return hints.shown;
    }
    hints.shown_for += dt;
    hints.step_time += dt;
    const bool other_step = hints.step != work.lesson.current;
    if (other_step) begin_step(hints, work);
    const Situation underlying = situation(work);
    update_progress(hints.progress, work, underlying, dt);

    const LessonStep* due = work.lesson.due();
    const bool announces =
        due != nullptr && on_the_way(underlying) && hints.step_time < announcement_duration;
    const Situation candidate = announces ? announcement(*due, hints.new_pass) : underlying;
    hints.candidate_for = candidate == hints.candidate ? hints.candidate_for + dt : 0.0;
    hints.differs_for = candidate == hints.shown_situation ? 0.0 : hints.differs_for + dt;
    hints.candidate = candidate;
    bool other = false;
    if (other_step || replaces(hints, candidate)) {
        hints.shown_situation = candidate;
        hints.shown_for = hints.differs_for = 0.0;
        hints.level = -1;
        other = true;
    }

    const bool guided = work.lesson.mode == Mode::guided;
    int level =
        std::max(hints.level, level_by_time(guided ? guided_times : practice_times, hints.progress.idle));
    if (requested) level = std::min(level + 1, max_level);
    // The hint is made anew also if its situation continues, but another joint is in the hand or another
    // motion is needed. It keeps its text if it is only shown longer than its situation lasts.
    other = other || (candidate == hints.shown_situation &&
                      (work.lesson.held_joint != hints.held_joint || underlying != hints.underlying));
    hints.level = level;
    if (level < 0) {
        hints.shown.reset();
    } else if (other || !hints.shown) {
        if (!hints.shown) hints.shown_for = 0.0;
        hints.held_joint = work.lesson.held_joint;
        hints.underlying = underlying;
        hints.shown = make_hint(hints.shown_situation, underlying, level, work);
    } else {
        hints.shown->level = hints.shown->joint < 0 ? 0 : level;
    }
    return hints.shown;
}

}  // namespace bolt::lesson
