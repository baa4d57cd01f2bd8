#include "tests/dead_ends/watch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dead_ends {

namespace {

constexpr std::size_t most_troubles = 5;
constexpr double frame_time = 0.016;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool finite(const Pose& pose) {
    const Quat& q = pose.orientation;
    return finite(pose.position) && std::abs(glm::dot(q, q) - 1.0) < 1e-3;
}

std::size_t index(lesson::Situation s) { return static_cast<std::size_t>(s); }

}  // namespace

void Watch::trouble(const std::string& what) {
    if (troubles_.size() < most_troubles)
        troubles_.push_back(fmt::format("{:.3f} s, step {}: {}", course_.time(), step_, what));
}

void Watch::look_at_output(const servo::Output& output) {
    const force::OutputLimits& limits = course_.setup().limits;
    const auto joints = static_cast<int>(course_.setup().nuts.size());
    if (!finite(output.force) || !finite(output.torque)) trouble("a force that is no number");
    if (glm::length(output.force) > limits.force * (1.0 + 1e-9)) trouble("more force than the device takes");
    if (glm::length(output.torque) > limits.torque * (1.0 + 1e-9))
        trouble("more torque than the device takes");
    if (!finite(output.tool)) trouble("a tool that is nowhere");
    if (!std::isfinite(output.wrench_torque) || !std::isfinite(output.nut_angle) ||
        !std::isfinite(output.clamp) || !std::isfinite(output.rounded))
        trouble("a true value that is no number");
    for (const int joint : {static_cast<int>(output.joint), static_cast<int>(output.slipped)})
        if (joint < -1 || joint >= joints) trouble(fmt::format("there is no joint {}", joint));
    if (output.fault != fault_) ++met_.faults.at(static_cast<std::size_t>(output.fault));
    fault_ = output.fault;
}

void Watch::look_at_joints() {
    const servo::State& state = course_.state();
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        const joint::JointState& joint = state.joints[i];
        if (!std::isfinite(joint.nut.angle) || !std::isfinite(joint.nut.speed) ||
            !std::isfinite(joint.torque) || !std::isfinite(joint.clamp))
            trouble(fmt::format("joint {} is no number", i));
        if (joint.clamp < -1e-6) trouble(fmt::format("joint {} pushes its members apart", i));
        if (!(state.rounded[i] >= 0.0)) trouble(fmt::format("joint {} has grown corners", i));
    }
}

void Watch::look_at_lesson(const servo::Output& output) {
    const lesson::Lesson& lesson = course_.lesson();
    if (lesson.current > lesson.steps.size()) trouble("there is no such step");
    if (lesson.held < -1 || lesson.held >= static_cast<int>(lesson.joints.size()))
        trouble("the lesson holds a joint that is not there");
    if (lesson.held != output.joint && output.undone == 0)
        trouble(fmt::format("the lesson thinks that {} is held, and {} is", lesson.held, output.joint));
    if (lesson.begun.size() != std::min(lesson.current + 1, lesson.steps.size()))
        trouble("the lesson does not know how its steps began");
    if (lesson.current < step_ && output.undone == 0) trouble("a step was taken back by nobody");
    if (output.undone > 0 && lesson.mode == lesson::Mode::assessment) trouble("an assessment was taken back");
    step_ = lesson.current;
    met_.undone += output.undone;
    for (const lesson::Event& event : course_.events())
        ++met_.events[event.kind != "mistake" ? event.kind
                                              : fmt::format("mistake {}", static_cast<int>(event.cause))];
}

// Whoever goes back finds the nuts as they were when that step began.
void Watch::look_at_marks(const servo::Output& output) {
    bool begins = false;
    for (const lesson::Event& event : course_.events()) begins = begins || event.kind == "step_begin";
    if (output.undone == 0 && !begins) return;
    const std::size_t step = course_.lesson().current;
    std::vector<double> now;
    for (const joint::JointState& joint : course_.state().joints) now.push_back(joint.nut.angle);
    if (output.undone > 0) {
        const auto begun = begun_.find(step);
        if (begun == begun_.end()) {
            trouble("back at a step that had not begun");
            return;
        }
        for (std::size_t i = 0; i < now.size(); ++i)
            if (std::abs(begun->second[i] - now[i]) > to_radians(0.5))
                trouble(fmt::format("back at step {}, but nut {} stands at {:.1f}°, not {:.1f}°", step, i,
                                    to_degrees(now[i]), to_degrees(begun->second[i])));
    } else {
        begun_[step] = now;
    }
}

void Watch::look_at_verdicts() {
    const session::Played played = course_.judged();
    if (!(played.result.score >= 0.0 && played.result.score <= 100.0)) trouble("no score");
    if (played.result.finished != course_.over()) trouble("finished and not over, or over and not finished");
    for (const lesson::JointResult& joint : played.result.joints) {
        const bool ok = joint.overall == lesson::Verdict::ok;
        const bool off =
            joint.torque_verdict == lesson::Verdict::low || joint.torque_verdict == lesson::Verdict::high ||
            joint.angle_verdict == lesson::Verdict::low || joint.angle_verdict == lesson::Verdict::high ||
            joint.condition != joint::Condition::sound;
        if (ok && off) trouble(joint.id + " is OK, and is not");
        if (!std::isfinite(joint.torque) || !std::isfinite(joint.angle) || !std::isfinite(joint.clamp))
            trouble(joint.id + " was judged to be no number");
    }
}

void Watch::tick(const servo::Output& output) {
    look_at_output(output);
    look_at_lesson(output);
    look_at_marks(output);
}

void Watch::frame(const servo::Output& output, bool wrench_in_hand, double room, bool asks) {
    look_at_joints();
    if (++frames_ % 32 == 0) look_at_verdicts();
    const lesson::Lesson& lesson = course_.lesson();
    const servo::State& state = course_.state();
    const lesson::Scene scene{lesson, course_.setup(),
                              world_.write(state.joints, state.rounded, output, wrench_in_hand, room)};
    const lesson::Situation now = lesson::situation(scene);
    if (was_ && *was_ != now) ++met_.left.at(index(*was_));
    if (!was_ || *was_ != now) ++met_.reached.at(index(now));
    was_ = now;
    const std::optional<lesson::Situation> before =
        hints_.shown ? std::optional(hints_.shown->situation) : std::nullopt;
    const std::optional<lesson::Hint>& hint = lesson::update(hints_, scene, frame_time, asks);
    if (hint && before != hint->situation) ++met_.said.at(index(hint->situation));
    if (!hint && lesson.mode == lesson::Mode::guided) trouble("nothing is said in a guided lesson");
    if (hint && lesson.mode == lesson::Mode::assessment) trouble("an assessment gives hints");
}

}  // namespace dead_ends
