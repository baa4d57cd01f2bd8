#include "game/operators/operator.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "game/operators/motion.hpp"

namespace bolt::operators {

namespace {

using lesson::StepKind;
using servo::Grip;

constexpr double hover = 0.025;         // m above the nut before lowering and after lifting
constexpr double arc = 0.05;            // m, height of a reach between joints
constexpr double seated_torque = 0.45;  // N·m at which fingers call a nut seated
constexpr double spin_stroke = 200.0;   // degrees of one finger twist
constexpr double loose_free = 40.0;     // degrees turned at next to no torque: the nut is free

// What the hand is doing. Each phase ends by choosing the next.
enum class Phase { think, reach, lower, settle, pull, ease, lift, spin, spin_back, done };

// Orientation of a tool whose handle stands at the given angle about the bolt (tightening positive).
Quat orientation_of(const servo::NutPlace& nut, double handle_angle, bool flipped) {
    const Vec3 x = std::cos(-handle_angle) * nut.e1 + std::sin(-handle_angle) * nut.e2;
    const Vec3 z = flipped ? -nut.axis : nut.axis;
    const Vec3 y = glm::cross(z, x);
    return glm::normalize(glm::quat_cast(glm::dmat3(x, y, z)));
}

servo::DeviceSample sample_of(const Pose& pose) {
    servo::DeviceSample sample;
    for (int i = 0; i < 3; ++i) sample.position[i] = static_cast<float>(pose.position[i]);
    sample.orientation[0] = static_cast<float>(pose.orientation.w);
    sample.orientation[1] = static_cast<float>(pose.orientation.x);
    sample.orientation[2] = static_cast<float>(pose.orientation.y);
    sample.orientation[3] = static_cast<float>(pose.orientation.z);
    return sample;
}

}  // namespace

struct Operator::Mind {
    Profile profile;
    Random random;
    Tremor tremor;
    Phase phase = Phase::think;
    double time = 0.0;   // s since the lesson began
    double begun = 0.0;  // s, when the phase began
    double wait = 0.0;   // s, how long it lasts, where it has a length
    std::size_t step = SIZE_MAX;
    std::size_t joint = 0;  // the joint that it believes is due
    int tries = 0;              // at this step before
    double goal = 0.0;      // N·m at which it means to stop
    bool wrong = false;     // it went to a wrong joint
    Pose from, to;          // of the movement
    bool flipped = false;
    double handle = 0.0;  // rad, handle angle about the bolt now
    double stroke_begin = 0.0;
    double free_turn = 0.0;    // rad turned without resistance, loosening
    bool finished = false;     // with this step, as far as it can tell
    Vec3 placed{0.0};          // m, how far off the centre it put the tool
    std::vector<double> felt;  // N·m, ring of the last `reaction` seconds
    std::size_t felt_at = 0;
    double felt_last = 0.0;
    double felt_rate = 0.0;  // N·m/s, smoothed over 30 ms
    double dt;

    Mind(const Profile& p, std::uint64_t seed, double step_dt)
        : profile(p), random(seed, 7001), tremor(random), dt(step_dt) {
        felt.resize(std::max<std::size_t>(1, static_cast<std::size_t>(p.reaction / dt)), 0.0);
    }

    [[nodiscard]] double elapsed() const { return time - begun; }
    [[nodiscard]] double share() const { return wait > 0.0 ? elapsed() / wait : 1.0; }

    void enter(Phase next, double length = 0.0) {
        phase = next;
        begun = time;
        wait = length;
    }

    // The torque it feels: late, as nerves are.
    double feel(double torque) {
        const double late = felt[felt_at];
        felt[felt_at] = torque;
        felt_at = (felt_at + 1) % felt.size();
        felt_rate += ((late - felt_last) / dt - felt_rate) * std::min(1.0, dt / 0.03);
        felt_last = late;
        return late;
    }

    void decide(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson);
    void choose_grip_angle(const servo::Setup& setup, const servo::State& state, bool loosening);
    void start_reach(const servo::Setup& setup, const servo::State& state);
    [[nodiscard]] Pose at_nut(const servo::Setup& setup, const servo::State& state, double above) const;
    void pull(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson,
              double torque);
    void spin(const servo::Setup& setup, double torque);
};

Pose Operator::Mind::at_nut(const servo::Setup& setup, const servo::State& state, double above) const {
    const servo::NutPlace& nut = setup.nuts[joint];
    Pose pose;
    pose.position = servo::nut_centre(nut, state.joints[joint].nut.angle) + nut.axis * above + placed;
    pose.orientation = orientation_of(nut, handle, flipped);
    return pose;
}

// Which step is due, and how this person will go about it.
void Operator::Mind::decide(const servo::Setup& setup, const servo::State& state,
                            const lesson::Lesson& lesson) {
    const lesson::Step* due = lesson.due();
    if (due == nullptr) {
        enter(Phase::done);
        return;
    }
    const bool again = step == lesson.current && !wrong;
    if (!again || finished) {
        const bool retry = step == lesson.current;
        tries = retry ? tries + 1 : 0;
        step = lesson.current;
        joint = due->joint;
        wrong = false;
        finished = false;
        free_turn = 0.0;
        if (!retry && due->kind != StepKind::run_down && random.chance(profile.wrong_joint) &&
            setup.nuts.size() > 1) {
            wrong = true;
            joint = (due->joint + 1 + random.bits() % (setup.nuts.size() - 1)) % setup.nuts.size();
        }
        double stop = 1.0 + profile.torque_bias + profile.torque_noise * random.normal();
        if (!retry && random.chance(profile.stops_early)) stop *= 0.75;
        if (random.chance(profile.overdoes)) stop *= 1.25;
        stop += 0.04 * tries;  // it was not enough: a little more
        goal = (wrong ? 0.3 : 1.0) * due->torque * stop;
    }
    const bool fingers = due->kind == StepKind::run_down;
    if (fingers) {
        flipped = false;
        handle = random.uniform(0.0, 2.0 * pi);
    } else {
        choose_grip_angle(setup, state, due->kind == StepKind::loosen);
    }
    placed = Vec3(random.normal(), random.normal(), random.normal()) *
             (profile.position_noise * (fingers ? 3.0 : 1.0));
}

// Of the angles at which the jaw fits (every 60°, and 30° between with the wrench flipped), the one that
// leaves the longest pull before the arm is at its end. The arm is at ease with the handle within ±0.5 rad of
// the trainee's side.
void Operator::Mind::choose_grip_angle(const servo::Setup& setup, const servo::State& state, bool loosening) {
    const double nut_angle = state.joints[joint].nut.angle;
    const double wanted = (loosening ? 0.5 : -0.5) + 0.5 * pi;
    double best = 1e9;
    for (const bool flip : {false, true}) {
        const double head = flip ? setup.wrench.head_angle : -setup.wrench.head_angle;
        const double fits = nut_angle - head;  // handle angle at which the jaw lies on the flats, modulo 60°
        const double candidate = wanted + wrap(fits - wanted, pi / 3.0);
        if (std::abs(candidate - wanted) < best) {
            best = std::abs(candidate - wanted);
            handle = candidate;
            flipped = flip;
        }
    }
    handle += profile.angle_noise * random.normal();
}

// A short way takes less time than a long one, but never none (Fitts).
void Operator::Mind::start_reach(const servo::Setup& setup, const servo::State& state) {
    to = at_nut(setup, state, hover);
    const double far = std::min(1.0, 0.35 + glm::distance(from.position, to.position) / 0.3);
    enter(Phase::reach, far * profile.reach_time * random.uniform(0.85, 1.2));
}

void Operator::Mind::pull(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson,
                          double torque) {
    const bool loosening = lesson.task == lesson::Task::loosen;
    const double sign = loosening ? -1.0 : 1.0;
    const double nut_speed = std::abs(state.joints[joint].nut.speed);
    // A hand on a wrench controls force: it lets the torque grow at a rate, slower towards the goal, and
    // follows the nut when it moves. dT/dt = K (hand speed − nut speed) turns that into how fast the handle
    // goes.
    const double load = std::abs(torque);
    const double scale = loosening ? setup.wrench.stiffness * to_radians(1.0) : goal;
    const double rate =
        scale *
        std::max(profile.final_rate, loosening ? profile.load_rate : profile.load_rate * (1.0 - load / goal));
    const double speed = std::min(profile.pull_speed * std::min(1.0, elapsed() / 0.15),
                                  rate / setup.wrench.stiffness + nut_speed);
    handle += sign * speed * setup.dt;

    if (loosening) {
        free_turn = load < 1.0 ? free_turn + nut_speed * setup.dt : 0.0;
        finished = free_turn > to_radians(loose_free);
    } else {
        finished = load + profile.anticipation * profile.reaction * std::max(felt_rate, 0.0) >= goal;
    }
    const bool stroke_over = std::abs(handle - stroke_begin) >= profile.stroke;
    if (finished || stroke_over) enter(Phase::ease, 0.18);
}

void Operator::Mind::spin(const servo::Setup& setup, double torque) {
    handle += profile.spin_speed * setup.dt * minimum_jerk(elapsed() / 0.1);
    finished = torque > seated_torque;
    if (finished || handle - stroke_begin > to_radians(spin_stroke))
        enter(Phase::spin_back, finished ? 0.3 : 0.12);
}

Operator::Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup)
    : mind_(std::make_unique<Mind>(profile, seed, setup.dt)) {
    Vec3 centre(0.0);
    for (const servo::NutPlace& nut : setup.nuts) centre += nut.seat / static_cast<double>(setup.nuts.size());
    mind_->from.position = centre + Vec3(0.0, 0.3, 0.4);  // the hand rests in front of the assembly
    mind_->to = mind_->from;
}

Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;
Operator::~Operator() = default;

servo::Input Operator::act(const servo::Setup& setup, const servo::State& state,
                           const lesson::Lesson& lesson) {
    Mind& m = *mind_;
    m.time += setup.dt;
    const lesson::Step* due = lesson.due();
    const bool fingers = due != nullptr && due->kind == StepKind::run_down;
    const double torque = m.feel(state.joints[m.joint].torque);
    const bool held = state.engagement.joint == static_cast<int>(m.joint);

    servo::Input input;
    input.enabled = true;
    input.guide = due != nullptr ? static_cast<std::int16_t>(due->joint) : std::int16_t{-1};
    Pose pose = m.from;
    switch (m.phase) {
        case Phase::think:
            if (m.elapsed() < m.wait) break;
            m.decide(setup, state, lesson);
            if (m.phase != Phase::done) m.start_reach(setup, state);
            break;
        case Phase::reach:
            pose = along(m.from, m.to, minimum_jerk(m.share()), setup.nuts[m.joint].axis,
                         std::min(arc, 0.3 * glm::distance(m.from.position, m.to.position)));
            if (m.share() >= 1.0) {
                m.from = m.to;
                m.enter(Phase::lower, m.profile.placing_time * m.random.uniform(0.8, 1.3));
            }
            break;
        case Phase::lower:
            pose = along(m.from, m.at_nut(setup, state, 0.0), minimum_jerk(m.share()), Vec3(0.0), 0.0);
            if (m.share() >= 1.0) m.enter(Phase::settle, 0.12);
            break;
        case Phase::settle:
            input.grip = fingers ? Grip::fingers : Grip::wrench;
            pose = m.at_nut(setup, state, 0.0);
            if (held) {
                m.stroke_begin = m.handle;
                m.enter(fingers ? Phase::spin : Phase::pull);
            } else if (m.share() >= 1.0) {
                // It does not slide on: place it again and turn it a little, as anybody would.
                m.placed = Vec3(m.random.normal(), m.random.normal(), m.random.normal()) *
                           (0.7 * m.profile.position_noise);
                m.choose_grip_angle(setup, state, due != nullptr && due->kind == StepKind::loosen);
                m.enter(Phase::settle, 0.15);
            }
            break;
        case Phase::pull:
            input.grip = Grip::wrench;
            m.pull(setup, state, lesson, torque);
            pose = m.at_nut(setup, state, 0.0);
            if (!held) m.enter(Phase::lift, 0.3);  // it slipped off
            break;
        case Phase::ease: {
            // Let the wrench unwind before it comes off.
            input.grip = Grip::wrench;
            const double wound = state.joints[m.joint].torque / setup.wrench.stiffness;
            m.handle -= wound * std::min(1.0, setup.dt / 0.04) * std::min(1.0, m.elapsed() / 0.03);
            pose = m.at_nut(setup, state, 0.0);
            if (m.share() >= 1.0) {
                m.from = pose;
                m.to = m.at_nut(setup, state, hover);
                m.enter(Phase::lift, 0.25);
            }
            break;
        }
        case Phase::lift:
            pose = along(m.from, m.to, minimum_jerk(m.share()), Vec3(0.0), 0.0);
            if (m.share() >= 1.0) {
                m.from = m.to;
                const bool over = m.finished || due == nullptr || m.step != lesson.current;
                m.enter(Phase::think, over ? m.profile.pause * m.random.uniform(0.3, 1.7) : 0.05);
            }
            break;
        case Phase::spin:
            input.grip = Grip::fingers;
            m.spin(setup, torque);
            pose = m.at_nut(setup, state, 0.0);
            break;
        case Phase::spin_back:
            // Open the fingers, turn the hand back, take hold again.
            if (!m.finished) m.handle -= to_radians(spin_stroke) / m.wait * setup.dt;
            pose = m.at_nut(setup, state, 0.0);
            if (m.share() < 1.0) break;
            m.from = pose;
            m.to = m.at_nut(setup, state, hover);
            if (m.finished)
                m.enter(Phase::lift, 0.3);
            else
                m.enter(Phase::settle, 0.05);
            break;
        case Phase::done:
            break;
    }
    if (m.phase != Phase::done) {
        pose.position += m.tremor.at(m.time) * m.profile.tremor;
        if (m.phase == Phase::pull) {
            const double sway = m.profile.tremor_torsion * m.tremor.torsion(m.time);
            pose.orientation = orientation_of(setup.nuts[m.joint], m.handle + sway, m.flipped);
        }
    }
    input.device = sample_of(pose);
    return input;
}

}  // namespace bolt::operators
