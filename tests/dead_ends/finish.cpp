// A competent trainee takes over and finishes the lesson from its present state.
#include <fmt/format.h>

#include <algorithm>

#include "game/trainees/trainee.hpp"
#include "tests/dead_ends/lesson_run.hpp"

namespace dead_ends {

namespace {

constexpr double patience = 60.0,
                 experts_patience = 120.0;  // s without progress before a step is restarted

constexpr double progress = to_radians(20.0), tighter_by = 0.05;  // relative to the due torque

constexpr int max_restarts = 4, experts_restarts = 2;

void report_dead_end(LessonRun& run) {
    const lesson::LessonStep* due = run.session.lesson().due();
    if (due == nullptr) return run.checker.report("a dead end: the mistake in the last step is never undone");
    const auto& joint = run.session.state().joints[due->joint];
    run.checker.report(
        fmt::format("a dead end: {} joint {}, {:.1f} N·m, nut at {:.1f}°, {:.2f} mm rounded, clamp {:.0f} N",
                    lesson::name(due->kind), due->joint, joint.torque, to_degrees(joint.nut.angle),
                    1e3 * run.session.state().rounded[due->joint], joint.clamp));
}

// Time without progress: the step is the same, and its nut has neither turned further nor become tighter. A
// nut far from its seat, or one among obstacles, takes many pulls.
struct Patience {
    std::size_t step = SIZE_MAX;
    double since = 0.0, furthest = 0.0, tightest = 0.0;
    double lasts = patience;  // s

    bool over(const session::LessonSession& session) {
        const lesson::LessonStep* due = session.lesson().due();
        if (due == nullptr) {  // a mistake in the last step is to be undone
            if (std::exchange(step, session.lesson().current) != step) since = session.time();
            return session.time() - since > lasts;
        }
        const double sense = due->kind == lesson::StepKind::loosen ? -1.0 : 1.0;
        const double turned = sense * session.state().joints[due->joint].nut.angle;
        const double torque = sense * session.state().joints[due->joint].torque;
        const bool tighter = torque > tightest + tighter_by * due->torque;
        if (session.lesson().current != step || turned > furthest + progress || tighter) {
            if (session.lesson().current != step) tightest = 0.0;
            step = session.lesson().current;
            since = session.time();
            furthest = turned;
            tightest = std::max(tightest, torque);
        }
        return session.time() - since > lasts;
    }
    // Steps to undo: restarts the step first, then goes back further with each restart.
    std::size_t back(const session::LessonSession& session, int restarts) {
        since = session.time();
        return std::min<std::size_t>(static_cast<std::size_t>(restarts - 1), session.lesson().current);
    }
};

// Moves the empty hand to its initial position.
void withdraw_hand(LessonRun& run, const Vec3& at) {
    const double begun = run.session.time();
    const Pose from = run.player.hand.pose;
    const double seconds = 0.5 + glm::distance(from.position, at) / 0.4;
    while (!run.over() && run.session.time() - begun < seconds) {
        const double share = (run.session.time() - begun) / (seconds - 0.3);
        servo::TickInput input;
        const Pose now{glm::mix(from.position, at, std::clamp(share, 0.0, 1.0)), Quat(1, 0, 0, 0)};
        input.commanded_tool = servo::to_commanded_tool(now);
        input.reset = share < 0.1;
        input.dead_man = share > 0.2;
        run.player.hand.pose = now;
        if (!run.tick(input, false, std::numeric_limits<double>::infinity())) return;
    }
}

}  // namespace

int finish_at_mouse(LessonRun& run) {
    Patience patient;
    int restarts = 0;
    trainer_test::Player& player = run.player;
    player.button_down = false;
    while (!run.over() && !run.failed()) {
        std::optional<std::size_t> undo;
        if (patient.over(run.session)) {
            if (++restarts > max_restarts || run.session.lesson().mode == lesson::Mode::assessment ||
                run.session.finished()) {
                report_dead_end(run);
                break;
            }
            undo = patient.back(run.session, restarts);
        }
        trainer::MouseCommand command;
        const bool waits = undo || run.undo.target;
        if (waits)
            player.button_down = false;
        else
            command = trainer_test::next_command(player, run.session, frame_seconds);
        run.frame(command, undo);
    }
    return restarts;
}

int finish_at_device(LessonRun& run, std::uint64_t seed) {
    const trainees::TraineeProfile expert = trainees::find_profile("expert").value();
    const servo::Setup& setup = run.session.setup();
    Vec3 rest(0.0, 0.3, 0.4);
    for (const servo::NutGeometry& nut : setup.nuts)
        rest += nut.seat / static_cast<double>(setup.nuts.size());
    int restarts = 0;
    Patience patient;
    patient.lasts = experts_patience;
    while (!run.over() && !run.failed()) {
        withdraw_hand(run, rest);
        if (restarts > 0) run.session.request_undo(patient.back(run.session, restarts));
        trainees::SimulatedTrainee trainee(expert, seed + static_cast<std::uint64_t>(restarts), setup);
        bool wrench = false;
        while (!run.over() && !run.failed() && !patient.over(run.session)) {
            const servo::TickInput input = trainee.act(setup, run.session.state(), run.session.lesson());
            if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
            const float* at = input.commanded_tool.position;
            run.player.hand.pose.position = Vec3(at[0], at[1], at[2]);
            run.tick(input, wrench, std::numeric_limits<double>::infinity());
        }
        if (run.over() || run.failed()) break;
        // Simulated experts search by touch and go wrong where the wrench rubs against an obstacle. It is
        // sufficient if the trainee at the mouse can finish.
        if (++restarts < experts_restarts) continue;
        withdraw_hand(run, rest);
        return restarts + finish_at_mouse(run);
    }
    return restarts;
}

}  // namespace dead_ends
