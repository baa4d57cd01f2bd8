#include "tests/dead_ends/invariant_checker.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dead_ends {

namespace {

constexpr std::size_t max_problems = 5;
constexpr double frame_time = 0.016;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool finite(const Pose& pose) {
    const Quat& q = pose.orientation;
    return finite(pose.position) && std::abs(glm::dot(q, q) - 1.0) < 1e-3;
}

std::size_t index(lesson::Situation s) { return static_cast<std::size_t>(s); }

}  // namespace

void InvariantChecker::report(const std::string& what) {
    if (problems_.size() < max_problems)
        problems_.push_back(fmt::format("{:.3f} s, step {}: {}", session_.time(), step_, what));
}

void InvariantChecker::check_output(const servo::Output& output) {
    const force::OutputLimits& limits = session_.setup().limits;
    const auto joints = static_cast<int>(session_.setup().nuts.size());
    if (!finite(output.force) || !finite(output.torque)) report("the force is not finite");
    if (glm::length(output.force) > limits.force * (1.0 + 1e-9))
        report("the force exceeds the device's limit");
    if (glm::length(output.torque) > limits.torque * (1.0 + 1e-9))
        report("the torque exceeds the device's limit");
    if (!finite(output.constrained_tool)) report("the pose of the tool is not finite");
    if (!std::isfinite(output.wrench_torque) || !std::isfinite(output.nut_angle) ||
        !std::isfinite(output.clamp) || !std::isfinite(output.rounded))
        report("a physical value of the output is not finite");
    for (const int joint : {static_cast<int>(output.joint), static_cast<int>(output.slipped)})
        if (joint < -1 || joint >= joints) report(fmt::format("joint {} does not exist", joint));
    if (output.fault != fault_) ++coverage_.faults.at(static_cast<std::size_t>(output.fault));
    fault_ = output.fault;
}

void InvariantChecker::check_joints() {
    const servo::State& state = session_.state();
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        const joint::JointState& joint = state.joints[i];
        if (!std::isfinite(joint.nut.angle) || !std::isfinite(joint.nut.speed) ||
            !std::isfinite(joint.torque) || !std::isfinite(joint.clamp))
            report(fmt::format("joint {} has a value that is not finite", i));
        if (joint.clamp < -1e-6) report(fmt::format("joint {} has a negative clamp force", i));
        if (!(state.rounded[i] >= 0.0)) report(fmt::format("joint {} has negative corner wear", i));
    }
}

void InvariantChecker::check_lesson(const servo::Output& output) {
    const lesson::Lesson& lesson = session_.lesson();
    if (lesson.current > lesson.steps.size()) report("the current step does not exist");
    if (lesson.held_joint < -1 || lesson.held_joint >= static_cast<int>(lesson.joints.size()))
        report("the lesson holds a joint that does not exist");
    if (lesson.held_joint != output.joint && output.undone == 0)
        report(fmt::format("the lesson holds joint {}, the servo joint {}", lesson.held_joint, output.joint));
    if (lesson.step_starts.size() != std::min(lesson.current + 1, lesson.steps.size()))
        report("the lesson lacks the start of a step");
    if (lesson.current < step_ && output.undone == 0) report("a step was undone without an undo");
    if (output.undone > 0 && lesson.mode == lesson::Mode::assessment) report("an assessment was undone");
    step_ = lesson.current;
    coverage_.undone += output.undone;
    for (const lesson::LessonEvent& event : session_.events())
        ++coverage_.events[event.kind != lesson::EventKind::mistake
                               ? std::string(lesson::name(event.kind))
                               : fmt::format("mistake {}", static_cast<int>(event.mistake))];
}

// After an undo all nuts are as they were at the start of that step.
void InvariantChecker::check_checkpoints(const servo::Output& output) {
    bool begins = false;
    for (const lesson::LessonEvent& event : session_.events())
        begins = begins || event.kind == lesson::EventKind::step_begin;
    if (output.undone == 0 && !begins) return;
    const std::size_t step = session_.lesson().current;
    std::vector<double> now;
    for (const joint::JointState& joint : session_.state().joints) now.push_back(joint.nut.angle);
    if (output.undone > 0) {
        const auto begun = begun_.find(step);
        if (begun == begun_.end()) {
            report("undo to a step that had not begun");
            return;
        }
        for (std::size_t i = 0; i < now.size(); ++i)
            if (std::abs(begun->second[i] - now[i]) > to_radians(0.5))
                report(fmt::format("undo to step {}, but nut {} is at {:.1f}° instead of {:.1f}°", step, i,
                                   to_degrees(now[i]), to_degrees(begun->second[i])));
    } else {
        begun_[step] = now;
    }
}

void InvariantChecker::check_verdicts() {
    const session::LessonOutcome played = session_.outcome(world_.write(session_.state(), {}, false));
    if (!(played.result.score >= 0.0 && played.result.score <= 100.0)) report("the score is outside 0 … 100");
    if (played.result.finished != session_.finished())
        report("the result and the lesson disagree on whether it is finished");
    for (const lesson::JointResult& joint : played.result.joints) {
        const bool ok = joint.overall == lesson::Verdict::ok;
        const bool off =
            joint.torque_verdict == lesson::Verdict::low || joint.torque_verdict == lesson::Verdict::high ||
            joint.angle_verdict == lesson::Verdict::low || joint.angle_verdict == lesson::Verdict::high ||
            joint.condition != joint::JointCondition::intact;
        if (ok && off) report(joint.id + " is rated OK despite a failed criterion");
        if (!std::isfinite(joint.torque) || !std::isfinite(joint.angle) || !std::isfinite(joint.clamp))
            report(joint.id + " has a result that is not finite");
    }
}

void InvariantChecker::tick(const servo::Output& output) {
    check_output(output);
    check_lesson(output);
    check_checkpoints(output);
}

void InvariantChecker::frame(const servo::Output& output, bool wrench_in_hand, double free_swing,
                             bool hint_key) {
    check_joints();
    if (++frames_ % 32 == 0) check_verdicts();
    const lesson::Lesson& lesson = session_.lesson();
    const servo::State& state = session_.state();
    const lesson::ObservedLesson scene{lesson, session_.setup(),
                                       world_.write(state, output, wrench_in_hand, free_swing)};
    const lesson::Situation now = lesson::situation(scene);
    if (previous_ && *previous_ != now) ++coverage_.left.at(index(*previous_));
    if (!previous_ || *previous_ != now) ++coverage_.reached.at(index(now));
    previous_ = now;
    const std::optional<lesson::Situation> before =
        hints_.shown ? std::optional(hints_.shown->situation) : std::nullopt;
    const std::optional<lesson::Hint>& hint = lesson::update(hints_, scene, frame_time, hint_key);
    if (hint && before != hint->situation) ++coverage_.hinted.at(index(hint->situation));
    if (!hint && lesson.mode == lesson::Mode::guided) report("a guided lesson shows no hint");
    if (hint && lesson.mode == lesson::Mode::assessment) report("an assessment shows a hint");
}

}  // namespace dead_ends
