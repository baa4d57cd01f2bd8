// A competent trainee takes over and finishes the lesson from its present state.
#include <fmt/format.h>

#include <algorithm>

#include "game/trainees/trainee.hpp"
#include "tests/dead_ends/desk.hpp"

namespace dead_ends {

namespace {

constexpr double patience = 60.0,
                 experts_patience = 120.0;  // s without progress, before a step is begun anew

constexpr double progress = to_radians(20.0), tighter_by = 0.05;  // of what is due

constexpr int most_restarts = 4, experts_restarts = 2;

void dead_end(Desk& desk) {
    const lesson::Step* due = desk.course.lesson().due();
    if (due == nullptr) return desk.watch.trouble("a dead end: the last step's mistake is never taken back");
    const auto& joint = desk.course.state().joints[due->joint];
    desk.watch.trouble(
        fmt::format("a dead end: {} joint {}, {:.1f} N·m, nut at {:.1f}°, {:.2f} mm rounded, clamp {:.0f} N",
                    lesson::name(due->kind), due->joint, joint.torque, to_degrees(joint.nut.angle),
                    1e3 * desk.course.state().rounded[due->joint], joint.clamp));
}

// How long nothing has come of a step: it is the same, and its nut has neither been turned on nor become
// tighter. A nut that is far off its seat takes a wrench many pulls, and one among others that are in the way
// does too.
struct Patience {
    std::size_t step = SIZE_MAX;
    double since = 0.0, furthest = 0.0, tightest = 0.0;
    double lasts = patience;  // s

    bool over(const session::Course& course) {
        const lesson::Step* due = course.lesson().due();
        if (due == nullptr) {  // a mistake in the last step is to be taken back
            if (std::exchange(step, course.lesson().current) != step) since = course.time();
            return course.time() - since > lasts;
        }
        const double sense = due->kind == lesson::StepKind::loosen ? -1.0 : 1.0;
        const double turned = sense * course.state().joints[due->joint].nut.angle;
        const double torque = sense * course.state().joints[due->joint].torque;
        const bool tighter = torque > tightest + tighter_by * due->torque;
        if (course.lesson().current != step || turned > furthest + progress || tighter) {
            if (course.lesson().current != step) tightest = 0.0;
            step = course.lesson().current;
            since = course.time();
            furthest = turned;
            tightest = std::max(tightest, torque);
        }
        return course.time() - since > lasts;
    }
    // The step anew, then one back, then more.
    std::size_t back(const session::Course& course, int restarts) {
        since = course.time();
        return std::min<std::size_t>(static_cast<std::size_t>(restarts - 1), course.lesson().current);
    }
};

// The hand leaves all as it is and goes where it would begin, with nothing in it.
void come_to_rest(Desk& desk, const Vec3& at) {
    const double begun = desk.course.time();
    const Pose from = desk.player.hand.pose;
    const double seconds = 0.5 + glm::distance(from.position, at) / 0.4;
    while (!desk.over() && desk.course.time() - begun < seconds) {
        const double share = (desk.course.time() - begun) / (seconds - 0.3);
        servo::Input input;
        const Pose now{glm::mix(from.position, at, std::clamp(share, 0.0, 1.0)), Quat(1, 0, 0, 0)};
        input.device = servo::sample_of(now);
        input.reset = share < 0.1;
        input.enabled = share > 0.2;
        desk.player.hand.pose = now;
        if (!desk.tick(input, false, std::numeric_limits<double>::infinity())) return;
    }
}

}  // namespace

int finish_at_mouse(Desk& desk) {
    Patience patient;
    int restarts = 0;
    trainer_test::Player& player = desk.player;
    player.held = false;
    while (!desk.over() && !desk.stuck()) {
        std::optional<std::size_t> undo;
        if (patient.over(desk.course)) {
            if (++restarts > most_restarts || desk.course.lesson().mode == lesson::Mode::assessment ||
                desk.course.over()) {
                dead_end(desk);
                break;
            }
            undo = patient.back(desk.course, restarts);
        }
        trainer::Wish wish;
        const bool waits = undo || desk.back.to;
        if (waits)
            player.held = false;
        else
            wish = trainer_test::wish_of(player, desk.course, frame_seconds);
        desk.frame(wish, undo);
    }
    return restarts;
}

int finish_at_device(Desk& desk, std::uint64_t seed) {
    const trainees::Profile expert = trainees::find_profile("expert").value();
    const servo::Setup& setup = desk.course.setup();
    Vec3 rest(0.0, 0.3, 0.4);
    for (const servo::NutGeometry& nut : setup.nuts)
        rest += nut.seat / static_cast<double>(setup.nuts.size());
    int restarts = 0;
    Patience patient;
    patient.lasts = experts_patience;
    while (!desk.over() && !desk.stuck()) {
        come_to_rest(desk, rest);
        if (restarts > 0) desk.course.go_back(patient.back(desk.course, restarts));
        trainees::Operator trainee(expert, seed + static_cast<std::uint64_t>(restarts), setup);
        bool wrench = false;
        while (!desk.over() && !desk.stuck() && !patient.over(desk.course)) {
            const servo::Input input = trainee.act(setup, desk.course.state(), desk.course.lesson());
            if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
            const float* at = input.device.position;
            desk.player.hand.pose.position = Vec3(at[0], at[1], at[2]);
            desk.tick(input, wrench, std::numeric_limits<double>::infinity());
        }
        if (desk.over() || desk.stuck()) break;
        // Simulated experts feel their way, and are led astray where a wrench rubs against something else;
        // what counts
        // is whether anybody can go on from there.
        if (++restarts < experts_restarts) continue;
        come_to_rest(desk, rest);
        return restarts + finish_at_mouse(desk);
    }
    return restarts;
}

}  // namespace dead_ends
