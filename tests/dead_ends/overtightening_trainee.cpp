// Trainees who use the tools correctly but tighten too far: they break bolts, strip threads and round
// corners, and sometimes stop too early.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/dead_ends/lesson_run.hpp"

namespace dead_ends {

namespace {

constexpr double longest_at_a_joint = 60.0;  // s
constexpr double set_back_share = 0.97;      // fraction of the room at which the handle is set back

// A joint and the torque to which the trainee tightens it.
struct JointAttempt {
    std::size_t joint = 0;
    bool loosens = false;
    double goal = 0.0;   // N·m
    double rate = 0.0;   // rad/s of the handle
    double until = 0.0;  // s
    double peak = 0.0;   // N·m
};

JointAttempt random_attempt(Random& random, const session::LessonSession& session) {
    const lesson::Lesson& lesson = session.lesson();
    const lesson::LessonStep& due = *lesson.due();
    JointAttempt v;
    const std::size_t joints = session.setup().nuts.size();
    v.joint = random.chance(0.8) ? due.joint : random.bits() % joints;
    v.loosens = (lesson.task == lesson::Task::loosen) != random.chance(0.15);
    const double usual = std::max(due.torque, lesson.assembly->joints[v.joint].spec.torque.target);
    constexpr double shares[] = {0.3, 0.8, 1.0, 1.3, 2.0, 20.0};  // of the due torque
    v.goal = usual * shares[random.bits() % std::size(shares)];
    v.rate = random.uniform(0.3, 3.0);
    v.until = session.time() + longest_at_a_joint;
    return v;
}

bool done(const JointAttempt& v, const session::LessonSession& session) {
    const joint::JointState& joint = session.state().joints[v.joint];
    return v.peak >= v.goal || joint.condition != joint::JointCondition::intact || session.time() > v.until;
}

// Presses, drags as far as there is room, releases and presses again.
trainer::MouseCommand next_command(JointAttempt& v, trainer_test::Player& p,
                                   const session::LessonSession& session) {
    trainer::MouseCommand command;
    p.wait_left = std::max(0.0, p.wait_left - frame_seconds);
    if (!p.button_down) {
        if (p.hand.action != trainer::HandAction::resting || p.wait_left > 0.0) return command;
        if (!p.hand.wrench) {
            command.take_wrench = true;
            return command;
        }
        command.nut = v.joint;
        p.button_down = true;
    }
    command.loosens = v.loosens;
    command.button_down = true;
    const double sense = v.loosens ? -1.0 : 1.0;
    command.turn = sense * v.rate * frame_seconds;

    const bool on = session.state().engagement.joint == static_cast<int>(v.joint);
    if (on) v.peak = std::max(v.peak, sense * session.state().joints[v.joint].torque);
    const bool spent = p.hand.wrench && std::abs(p.hand.handle_angle - p.hand.stroke_begin) >
                                            set_back_share * p.hand.free_swing;
    const bool missed = p.hand.missed && p.hand.action == trainer::HandAction::resting;
    if ((p.hand.action == trainer::HandAction::holding && spent) || missed || done(v, session)) {
        command.button_down = p.button_down = false;
        p.wait_left = 0.2;
    }
    return command;
}

}  // namespace

void overtighten_at_mouse(LessonRun& run, std::uint64_t seed, double span) {
    Random random(seed, 9103);
    std::optional<JointAttempt> attempt;
    while (run.session.time() < span && !run.over() && !run.failed()) {
        if (attempt && done(*attempt, run.session) && !run.player.button_down) attempt.reset();
        const lesson::LessonStep* due = run.session.lesson().due();
        // No step is due while a mistake in the last step is being undone.
        if (!attempt && (due == nullptr || due->kind == lesson::StepKind::run_down)) {
            run.frame(trainer_test::next_command(run.player, run.session, frame_seconds));
            continue;
        }
        if (!attempt) attempt = random_attempt(random, run.session);
        run.frame(next_command(*attempt, run.player, run.session), std::nullopt, random.chance(5e-3));
    }
}

void overtighten_at_device(LessonRun& run, std::uint64_t seed, double span) {
    Random random(seed, 9104);
    trainees::TraineeProfile strong = trainees::find_profile("clumsy").value();
    strong.torque_bias = random.uniform(-0.2, 3.0);
    strong.overtightens = 0.4;
    strong.stops_early = 0.2;
    strong.load_rate = 6.0;
    trainees::SimulatedTrainee trainee(strong, seed, run.session.setup());
    bool wrench = false;
    while (run.session.time() < span && !run.over() && !run.failed()) {
        const servo::TickInput input =
            trainee.act(run.session.setup(), run.session.state(), run.session.lesson());
        if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
        run.tick(input, wrench, std::numeric_limits<double>::infinity(), random.chance(1e-3));
    }
    const float* at = run.last.commanded_tool.position;
    run.player.hand.pose.position = Vec3(at[0], at[1], at[2]);
}

}  // namespace dead_ends
