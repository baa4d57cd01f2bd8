#include "game/lesson/mistakes.hpp"

namespace bolt::lesson {

namespace {

using lesson::Cause;
using words::Key;

struct Row {
    Cause cause;
    Key why, what_to_do;
};
constexpr Row rows[] = {
    {Cause::out_of_turn, "mistake.out_of_turn", "mistake.out_of_turn.do"},
    {Cause::done_already, "mistake.done_already", "mistake.done_already.do"},
    {Cause::loosened, "mistake.loosened", "mistake.loosened.do"},
    {Cause::tightened, "mistake.tightened", "mistake.tightened.do"},
    {Cause::over_torque, "mistake.over_torque", "mistake.over_torque.do"},
    {Cause::slipped, "mistake.slipped", "mistake.slipped.do"},
    {Cause::stripped, "mistake.stripped", "mistake.stripped.do"},
    {Cause::broken, "mistake.broken", "mistake.broken.do"},
};

std::optional<Mistake> mistake_of(const lesson::Lesson& lesson, const lesson::Event& event) {
    for (const Row& row : rows) {
        if (row.cause != event.cause) continue;
        const auto& joints = lesson.assembly->joints;
        const content::AssemblyJoint& joint = joints[static_cast<std::size_t>(event.joint)];
        Mistake mistake{event.cause, event.joint, row.why, row.what_to_do, {}};
        mistake.places = {{"held", joint.design.id},
                          {"most", words::torque_number(joint.spec.torque.high)},
                          {"rounded", words::Number{1e3 * event.value, 2}}};
        const lesson::Step* due = lesson.due();
        if (due != nullptr) {
            mistake.places.push_back({"joint", joints[due->joint].design.id});
        } else if (event.cause == Cause::out_of_turn || event.cause == Cause::done_already) {
            return std::nullopt;  // nothing is due any more that one could go to
        }
        return mistake;
    }
    return std::nullopt;
}

void show(Mistakes& mistakes, Mistake mistake) {
    mistakes.shown = std::move(mistake);
    mistakes.stands = 0.0;
}

}  // namespace

void note(Mistakes& mistakes, const lesson::Lesson& lesson, const lesson::Event& event) {
    if (lesson.mode == lesson::Mode::assessment) return;
    if (event.kind == "back") mistakes = {};
    std::optional<Mistake> mistake = mistake_of(lesson, event);
    if (!mistake) return;
    if (!mistakes.shown ||
        (mistakes.shown->cause == mistake->cause && mistakes.shown->joint == mistake->joint))
        show(mistakes, std::move(*mistake));
    else if (mistake->cause >= mistakes.shown->cause &&
             (!mistakes.waiting || mistake->cause >= mistakes.waiting->cause))
        mistakes.waiting = std::move(mistake);
}

const std::optional<Mistake>& update(Mistakes& mistakes, double dt) {
    if (!mistakes.shown) return mistakes.shown;
    mistakes.stands += dt;
    if (mistakes.waiting && mistakes.stands >= shortest_mistake) {
        show(mistakes, std::move(*mistakes.waiting));
        mistakes.waiting.reset();
    } else if (mistakes.stands >= mistake_stands) {
        mistakes.shown.reset();
    }
    return mistakes.shown;
}

std::string say_why(const words::Words& words, const Mistake& mistake) {
    return words::say(words, mistake.why, mistake.places);
}

std::string say_what_to_do(const words::Words& words, const Mistake& mistake) {
    return words::say(words, mistake.what_to_do, mistake.places);
}

}  // namespace bolt::lesson
