#include "game/lesson/feedback.hpp"

#include <algorithm>
#include <cmath>

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

namespace {

using lesson::Fault;
using lesson::Verdict;
using words::Key;

constexpr std::size_t most_advice = 3;

struct Judged {
    Key reason, advice;
};

Judged judged(const lesson::JointResult& joint) {
    if (joint.condition == joint::Condition::broken) return {"reason.broken", "advice.broken"};
    if (joint.condition == joint::Condition::stripped) return {"reason.stripped", "advice.stripped"};
    if (joint.torque_verdict == Verdict::none) return {"reason.not_loosened", "advice.not_loosened"};
    if (joint.torque_verdict == Verdict::low) return {"reason.torque_low", "advice.torque_low"};
    if (joint.torque_verdict == Verdict::high) return {"reason.torque_high", "advice.torque_high"};
    if (joint.angle_verdict == Verdict::low) return {"reason.angle_low", "advice.angle_low"};
    if (joint.angle_verdict == Verdict::high) return {"reason.angle_high", "advice.angle_high"};
    return {"reason.off_seat", "advice.off_seat"};
}

std::vector<words::Place> joint_places(const content::Specification& spec, const lesson::JointResult& joint) {
    const bool of_angle = joint.torque_verdict == Verdict::ok;
    const content::Window& window = of_angle ? spec.angle : spec.torque;
    const auto shown = [&](double value) {
        return of_angle ? words::Number{std::round(to_degrees(value)), 0} : words::torque_number(value);
    };
    // A tenth below the window is not shown as its edge.
    words::Number torque = words::torque_number(joint.torque);
    if (joint.torque < 100.0) torque.decimals = 1;
    return {{"joint", joint.id},
            {"torque", torque},
            {"angle", words::Number{to_degrees(joint.angle), 0}},
            {"low", shown(window.low)},
            {"high", shown(window.high)}};
}

struct Cost {
    Key advice;
    double points = 0.0;
};

void add(std::vector<Cost>& costs, Key advice, double points) {
    const auto it =
        std::find_if(costs.begin(), costs.end(), [&](const Cost& c) { return c.advice == advice; });
    if (it == costs.end())
        costs.push_back({advice, points});
    else
        it->points += points;
}

}  // namespace

Review review(const content::Assembly& assembly, const lesson::LessonResult& result) {
    Review review;
    std::vector<Cost> costs;
    for (const lesson::ScoreReason& reason : result.reasons) {
        Remark remark{
            reason.points, std::nullopt, {{"count", words::Number{1.0 * reason.count, 0}}}, reason.text};
        const bool once = reason.count == 1;
        std::optional<Key> advice;
        switch (reason.fault) {
            case Fault::none:
                break;
            case Fault::damaged:
            case Fault::not_ok: {
                const auto joint = static_cast<std::size_t>(reason.joint);
                const Judged how = judged(result.joints[joint]);
                remark.key = how.reason;
                remark.places = joint_places(assembly.joints[joint].spec, result.joints[joint]);
                advice = how.advice;
                break;
            }
            case Fault::out_of_turn:
                remark.key = once ? Key("reason.out_of_turn.one") : Key("reason.out_of_turn.many");
                advice = Key("advice.out_of_turn");
                break;
            case Fault::done_already:
                remark.key = once ? Key("reason.done_already.one") : Key("reason.done_already.many");
                advice = Key("advice.done_already");
                break;
            case Fault::wrong_way:
                remark.key = once ? Key("reason.wrong_way.one") : Key("reason.wrong_way.many");
                advice = Key("advice.wrong_way");
                break;
            case Fault::overdone:
                remark.key = once ? Key("reason.overdone.one") : Key("reason.overdone.many");
                advice = Key("advice.torque_high");
                break;
            case Fault::slipped:
                remark.key = once ? Key("reason.slipped.one") : Key("reason.slipped.many");
                advice = Key("mistake.slipped.do");
                break;
            case Fault::unfinished:
                remark.key = Key("reason.unfinished");
                remark.places = {{"step", words::Number{1.0 * reason.count, 0}},
                                 {"of", words::Number{1.0 * reason.of, 0}}};
                advice = Key("advice.unfinished");
                break;
        }
        if (advice) add(costs, *advice, -reason.points);
        review.reasons.push_back(std::move(remark));
    }
    // Equal costs stay in the order of the score's reasons.
    std::stable_sort(costs.begin(), costs.end(),
                     [](const Cost& a, const Cost& b) { return a.points > b.points; });
    for (std::size_t i = 0; i < std::min(costs.size(), most_advice); ++i)
        review.advice.push_back(costs[i].advice);
    if (result.reasons.empty()) review.advice.push_back(Key("advice.nothing"));
    return review;
}

std::string say(const words::Words& words, const Remark& remark) {
    return remark.key ? words::say(words, *remark.key, remark.places) : remark.text;
}

}  // namespace bolt::lesson
