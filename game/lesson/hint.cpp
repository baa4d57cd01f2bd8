#include "game/lesson/hint.hpp"

#include <algorithm>

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

}  // namespace bolt::lesson
