#include "game/lesson/feedback.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "game/lesson/fastener_names.hpp"

namespace bolt::lesson {

namespace {

using words::TextKey;

struct MistakeRow {
    MistakeKind kind;
    TextKey text, remedy;
};
constexpr MistakeRow mistake_rows[] = {
    {MistakeKind::out_of_turn, "mistake.out_of_turn", "mistake.out_of_turn.do"},
    {MistakeKind::done_already, "mistake.done_already", "mistake.done_already.do"},
    {MistakeKind::loosened, "mistake.loosened", "mistake.loosened.do"},
    {MistakeKind::tightened, "mistake.tightened", "mistake.tightened.do"},
    {MistakeKind::over_torque, "mistake.over_torque", "mistake.over_torque.do"},
    {MistakeKind::over_turned, "mistake.over_turned", "mistake.over_turned.do"},
    {MistakeKind::turned_together, "mistake.turned_together", "mistake.turned_together.do"},
    {MistakeKind::weak_tool, "mistake.weak_tool", "mistake.weak_tool.do"},
    {MistakeKind::torque_wrench_loosens, "mistake.torque_wrench_loosens", "mistake.torque_wrench_loosens.do"},
    {MistakeKind::tool_bent, "mistake.tool_bent", "mistake.tool_bent.do"},
    {MistakeKind::slipped, "mistake.slipped", "mistake.slipped.do"},
    {MistakeKind::stripped, "mistake.stripped", "mistake.stripped.do"},
    {MistakeKind::broken, "mistake.broken", "mistake.broken.do"},
};

// One row for each kind but `none`, in the order of the kinds.
constexpr bool has_all_mistakes() {
    if (std::size(mistake_rows) + 1 != mistake_kinds) return false;
    for (std::size_t i = 0; i < std::size(mistake_rows); ++i)
        if (static_cast<std::size_t>(mistake_rows[i].kind) != i + 1) return false;
    return true;
}
static_assert(has_all_mistakes());

void show(MistakeState& mistakes, Mistake mistake) {
    mistakes.shown = std::move(mistake);
    mistakes.shown_for = 0.0;
}

}  // namespace

std::optional<Mistake> mistake_of(const Lesson& lesson, const LessonEvent& event) {
    for (const MistakeRow& row : mistake_rows) {
        if (row.kind != event.mistake) continue;
        const auto& joints = lesson.assembly->joints;
        const content::AssemblyJoint& joint = joints[static_cast<std::size_t>(event.joint)];
        Mistake mistake{event.mistake, event.joint, row.text, row.remedy, {}};
        mistake.arguments = {{"held", joint.design.id},
                             fastener_argument(joint.design),
                             thread_argument(joint.design),
                             {"most", words::torque_number(joint.spec.torque.high)},
                             {"most_angle", words::Number{to_degrees(joint.spec.angle.high), 0}},
                             {"rounded", words::Number{1e3 * event.value, 2}},
                             {"bent_at", words::torque_number(event.value)},
                             {"bearable", words::torque_number(event.value)}};
        const LessonStep* due = lesson.due();
        if (due != nullptr) {
            mistake.arguments.push_back({"joint", joints[due->joint].design.id});
        } else if (event.mistake == MistakeKind::out_of_turn || event.mistake == MistakeKind::done_already) {
            return std::nullopt;  // no due joint to name
        }
        return mistake;
    }
    return std::nullopt;
}

void add_event(MistakeState& mistakes, const Lesson& lesson, const LessonEvent& event) {
    if (lesson.mode == Mode::assessment) return;
    if (event.kind == EventKind::undo) mistakes = {};
    std::optional<Mistake> mistake = mistake_of(lesson, event);
    if (!mistake) return;
    if (!mistakes.shown || (mistakes.shown->kind == mistake->kind && mistakes.shown->joint == mistake->joint))
        show(mistakes, std::move(*mistake));
    else if (mistake->kind >= mistakes.shown->kind &&
             (!mistakes.waiting || mistake->kind >= mistakes.waiting->kind))
        mistakes.waiting = std::move(mistake);
}

const std::optional<Mistake>& update(MistakeState& mistakes, double dt) {
    if (!mistakes.shown) return mistakes.shown;
    mistakes.shown_for += dt;
    if (mistakes.waiting && mistakes.shown_for >= min_mistake_duration) {
        show(mistakes, std::move(*mistakes.waiting));
        mistakes.waiting.reset();
    } else if (mistakes.shown_for >= mistake_duration) {
        mistakes.shown.reset();
    }
    return mistakes.shown;
}

std::string mistake_text(const words::Words& words, const Mistake& mistake) {
    return words::format_text(words, mistake.text, mistake.arguments);
}

std::string remedy_text(const words::Words& words, const Mistake& mistake) {
    return words::format_text(words, mistake.remedy, mistake.arguments);
}

namespace {

constexpr std::size_t max_advice = 3;

struct JointTexts {
    TextKey reason, advice;
};

// `from_mark`: the angle counts from a mark, not from the snug torque.
JointTexts joint_texts(const JointResult& joint, bool from_mark) {
    if (joint.condition == joint::JointCondition::broken) return {"reason.broken", "advice.broken"};
    if (joint.condition == joint::JointCondition::stripped) return {"reason.stripped", "advice.stripped"};
    if (joint.torque_verdict == Verdict::none) return {"reason.not_loosened", "advice.not_loosened"};
    if (joint.torque_verdict == Verdict::low) return {"reason.torque_low", "advice.torque_low"};
    if (joint.torque_verdict == Verdict::high) return {"reason.torque_high", "advice.torque_high"};
    if (from_mark && joint.angle_verdict == Verdict::low) return {"reason.turn_low", "advice.turn_low"};
    if (from_mark && joint.angle_verdict == Verdict::high) return {"reason.turn_high", "advice.turn_high"};
    if (joint.angle_verdict == Verdict::low) return {"reason.angle_low", "advice.angle_low"};
    if (joint.angle_verdict == Verdict::high) return {"reason.angle_high", "advice.angle_high"};
    return {"reason.off_seat", "advice.off_seat"};
}

std::vector<words::TextArgument> joint_arguments(const content::AssemblyJoint& assembly_joint,
                                                 const JointResult& joint) {
    const content::Specification& spec = assembly_joint.spec;
    const bool by_angle = joint.torque_verdict == Verdict::ok;
    const content::ToleranceWindow& window = by_angle ? spec.angle : spec.torque;
    const auto shown = [&](double value) {
        return by_angle ? words::Number{std::round(to_degrees(value)), 0} : words::torque_number(value);
    };
    // With one decimal, a torque just below the window does not show as the window's edge.
    words::Number torque = words::torque_number(joint.torque);
    if (joint.torque < 100.0) torque.decimals = 1;
    return {{"joint", joint.id},        fastener_argument(assembly_joint.design),
            {"torque", torque},         {"angle", words::Number{to_degrees(joint.angle), 0}},
            {"low", shown(window.low)}, {"high", shown(window.high)}};
}

struct AdviceCost {
    TextKey advice;
    double points = 0.0;
};

void add(std::vector<AdviceCost>& costs, TextKey advice, double points) {
    const auto it =
        std::find_if(costs.begin(), costs.end(), [&](const AdviceCost& c) { return c.advice == advice; });
    if (it == costs.end())
        costs.push_back({advice, points});
    else
        it->points += points;
}

}  // namespace

Review review(const content::Assembly& assembly, const LessonResult& result) {
    Review review;
    review.arguments.push_back(fasteners_argument(assembly));
    review.arguments.push_back(threads_argument(assembly));
    std::vector<AdviceCost> costs;
    for (const Deduction& reason : result.reasons) {
        DeductionText deduction{
            reason.points,
            std::nullopt,
            {{"count", words::Number{1.0 * reason.count, 0}}, fasteners_argument(assembly)},
            reason.text};
        const bool once = reason.count == 1;
        std::optional<TextKey> advice;
        switch (reason.kind) {
            case DeductionKind::none:
                break;
            case DeductionKind::damaged:
            case DeductionKind::not_ok: {
                const auto joint = static_cast<std::size_t>(reason.joint);
                const JointTexts how = joint_texts(result.joints[joint], turns_by_angle(assembly));
                deduction.key = how.reason;
                deduction.arguments = joint_arguments(assembly.joints[joint], result.joints[joint]);
                advice = how.advice;
                break;
            }
            case DeductionKind::out_of_turn:
                deduction.key = once ? TextKey("reason.out_of_turn.one") : TextKey("reason.out_of_turn.many");
                advice = TextKey("advice.out_of_turn");
                break;
            case DeductionKind::done_already:
                deduction.key =
                    once ? TextKey("reason.done_already.one") : TextKey("reason.done_already.many");
                advice = TextKey("advice.done_already");
                break;
            case DeductionKind::wrong_way:
                deduction.key = once ? TextKey("reason.wrong_way.one") : TextKey("reason.wrong_way.many");
                advice = TextKey("advice.wrong_way");
                break;
            case DeductionKind::over_torque:
                deduction.key = once ? TextKey("reason.over_torque_corrected.one")
                                     : TextKey("reason.over_torque_corrected.many");
                advice = TextKey("advice.torque_high");
                break;
            case DeductionKind::over_turned:
                deduction.key = once ? TextKey("reason.over_turned_corrected.one")
                                     : TextKey("reason.over_turned_corrected.many");
                advice = TextKey("advice.turn_high");
                break;
            case DeductionKind::slipped:
                deduction.key = once ? TextKey("reason.slipped.one") : TextKey("reason.slipped.many");
                advice = TextKey("mistake.slipped.do");
                break;
            case DeductionKind::turned_together:
                deduction.key =
                    once ? TextKey("reason.turned_together.one") : TextKey("reason.turned_together.many");
                advice = TextKey("mistake.turned_together.do");
                break;
            case DeductionKind::weak_tool:
                deduction.key = TextKey("reason.weak_tool");
                advice = TextKey("mistake.weak_tool.do");
                break;
            case DeductionKind::torque_wrench_loosens:
                deduction.key = TextKey("reason.torque_wrench_loosens");
                advice = TextKey("mistake.torque_wrench_loosens.do");
                break;
            case DeductionKind::tool_bent:
                deduction.key = once ? TextKey("reason.tool_bent.one") : TextKey("reason.tool_bent.many");
                advice = TextKey("mistake.tool_bent.do");
                break;
            case DeductionKind::unfinished:
                deduction.key = TextKey("reason.unfinished");
                deduction.arguments = {{"step", words::Number{1.0 * reason.count, 0}},
                                       {"of", words::Number{1.0 * reason.step_count, 0}}};
                advice = TextKey("advice.unfinished");
                break;
        }
        if (advice) add(costs, *advice, -reason.points);
        review.reasons.push_back(std::move(deduction));
    }
    // Stable: equal costs stay in the order of the reasons.
    std::stable_sort(costs.begin(), costs.end(),
                     [](const AdviceCost& a, const AdviceCost& b) { return a.points > b.points; });
    for (std::size_t i = 0; i < std::min(costs.size(), max_advice); ++i)
        review.advice.push_back(costs[i].advice);
    if (result.reasons.empty()) review.advice.push_back(TextKey("advice.nothing"));
    return review;
}

std::string deduction_text(const words::Words& words, const DeductionText& deduction) {
    return deduction.key ? words::format_text(words, *deduction.key, deduction.arguments) : deduction.text;
}

}  // namespace bolt::lesson
