// Trainees who use the tools correctly but tighten too far: they break bolts, strip threads and round
// corners, and sometimes let go too early.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/dead_ends/desk.hpp"

namespace dead_ends {

namespace {

constexpr double longest_at_a_joint = 60.0;  // s
constexpr double sure = 0.97;                // of the room: then the handle is set back

// One joint, and how far somebody goes there.
struct Venture {
    std::size_t joint = 0;
    bool loosens = false;
    double goal = 0.0;   // N·m
    double rate = 0.0;   // rad/s of the handle
    double until = 0.0;  // s
    double peak = 0.0;   // N·m
};

Venture venture_of(Random& random, const session::Course& course) {
    const lesson::Lesson& lesson = course.lesson();
    const lesson::Step& due = *lesson.due();
    Venture v;
    const std::size_t joints = course.setup().nuts.size();
    v.joint = random.chance(0.8) ? due.joint : random.bits() % joints;
    v.loosens = (lesson.task == lesson::Task::loosen) != random.chance(0.15);
    const double usual = std::max(due.torque, lesson.assembly->joints[v.joint].spec.torque.target);
    constexpr double shares[] = {0.3, 0.8, 1.0, 1.3, 2.0, 20.0};  // of the torque that is asked for
    v.goal = usual * shares[random.bits() % std::size(shares)];
    v.rate = random.uniform(0.3, 3.0);
    v.until = course.time() + longest_at_a_joint;
    return v;
}

bool done(const Venture& v, const session::Course& course) {
    const joint::JointState& joint = course.state().joints[v.joint];
    return v.peak >= v.goal || joint.condition != joint::Condition::sound || course.time() > v.until;
}

// Presses, drags as far as there is room, lets go and presses again.
trainer::Wish wish_of(Venture& v, trainer_test::Player& p, const session::Course& course) {
    trainer::Wish wish;
    p.waited = std::max(0.0, p.waited - frame_seconds);
    if (!p.held) {
        if (p.hand.doing != trainer::Doing::resting || p.waited > 0.0) return wish;
        if (!p.hand.wrench) {
            wish.wrench = true;
            return wish;
        }
        wish.nut = v.joint;
        p.held = true;
    }
    wish.loosens = v.loosens;
    wish.held = true;
    const double sense = v.loosens ? -1.0 : 1.0;
    wish.turn = sense * v.rate * frame_seconds;

    const bool on = course.state().engagement.joint == static_cast<int>(v.joint);
    if (on) v.peak = std::max(v.peak, sense * course.state().joints[v.joint].torque);
    const bool spent = p.hand.wrench && std::abs(p.hand.handle - p.hand.begun_at) > sure * p.hand.room;
    const bool missed = p.hand.missed && p.hand.doing == trainer::Doing::resting;
    if ((p.hand.doing == trainer::Doing::holding && spent) || missed || done(v, course)) {
        wish.held = p.held = false;
        p.waited = 0.2;
    }
    return wish;
}

}  // namespace

void overdo_at_mouse(Desk& desk, std::uint64_t seed, double span) {
    Random random(seed, 9103);
    std::optional<Venture> venture;
    while (desk.course.time() < span && !desk.over() && !desk.stuck()) {
        if (venture && done(*venture, desk.course) && !desk.player.held) venture.reset();
        const lesson::Step* due = desk.course.lesson().due();
        // Nothing is due while a mistake in the last step is taken back.
        if (!venture && (due == nullptr || due->kind == lesson::StepKind::run_down)) {
            desk.frame(trainer_test::wish_of(desk.player, desk.course, frame_seconds));
            continue;
        }
        if (!venture) venture = venture_of(random, desk.course);
        desk.frame(wish_of(*venture, desk.player, desk.course), std::nullopt, random.chance(5e-3));
    }
}

void overdo_at_device(Desk& desk, std::uint64_t seed, double span) {
    Random random(seed, 9104);
    trainees::Profile strong = trainees::find_profile("clumsy").value();
    strong.torque_bias = random.uniform(-0.2, 3.0);
    strong.overdoes = 0.4;
    strong.stops_early = 0.2;
    strong.load_rate = 6.0;
    trainees::Operator trainee(strong, seed, desk.course.setup());
    bool wrench = false;
    while (desk.course.time() < span && !desk.over() && !desk.stuck()) {
        const servo::Input input =
            trainee.act(desk.course.setup(), desk.course.state(), desk.course.lesson());
        if (input.grip != servo::Grip::none) wrench = input.grip == servo::Grip::wrench;
        desk.tick(input, wrench, std::numeric_limits<double>::infinity(), random.chance(1e-3));
    }
    const float* at = desk.last.device.position;
    desk.player.hand.pose.position = Vec3(at[0], at[1], at[2]);
}

}  // namespace dead_ends
