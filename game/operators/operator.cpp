#include "game/operators/operator.hpp"

#include <algorithm>
#include <cmath>

#include "game/operators/arm.hpp"
#include "game/operators/around.hpp"
#include "game/operators/nerves.hpp"

namespace bolt::operators {

namespace {

using lesson::StepKind;
using servo::Grip;

constexpr double hover = 0.025;        // m above the nut before lowering and after lifting
constexpr double arc = 0.05;           // m, height of a reach between joints, at most
constexpr double seated_share = 0.55;  // of what fingers can give: a nut that takes more sits
constexpr double finger_drag = 0.4;  // of what fingers can give: a nut that drags more is run down by wrench
constexpr double spin_stroke = 200.0;          // degrees of one finger twist
constexpr double loose_free = 40.0;            // degrees turned at next to no torque: the nut is free
constexpr double no_torque = 1.0;              // N·m, next to none at a wrench
constexpr double seen_turn = to_radians(0.5);  // of a nut that can be seen
constexpr double caught_at = 0.02;    // m that a wrench stays behind the hand's meaning: it is caught
constexpr double caught_after = 0.5;  // s
constexpr double retreat = 0.06;      // m
constexpr int patient_misses = 3;
constexpr double unwinding_time = 0.18;  // s to let the wrench spring back before it comes off

// What the hand is doing. Each phase ends by choosing the next.
enum class Phase { think, fetch, reach, lower, settle, pull, ease, lift, spin, spin_back, done };

// What it has made up its mind to do.
struct Intent {
    std::size_t step = SIZE_MAX;  // of the lesson
    std::size_t joint = 0;        // that it believes is due
    bool fingers = false;         // the nut is run down by hand
    bool loosening = false;
    bool wrong = false;           // it went to a wrong joint
    bool until_seated = false;    // it runs the nut down until it sits
    bool checks = false;          // it only wants to see the nut begin to move
    bool stops_at_yield = false;  // it means to stop where the resistance stops growing
    double goal = 0.0;            // N·m at which it means to stop
    double least = 0.0;           // N·m below which it knows that it is not done
    int tries = 0;                // at this step before
    bool finished = false;        // as far as it can tell
};

// Orientation of a tool whose handle stands at the given angle about the bolt (tightening positive).
Quat orientation_of(const servo::NutPlace& nut, double handle_angle, bool flipped) {
    const Vec3 x = std::cos(-handle_angle) * nut.e1 + std::sin(-handle_angle) * nut.e2;
    const Vec3 z = flipped ? -nut.axis : nut.axis;
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
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
    Nerves nerves;
    Intent intent;
    Phase phase = Phase::think;
    double time = 0.0;    // s since the lesson began
    double begun = 0.0;   // s, when the phase began
    double length = 0.0;  // s that the phase takes, where it has a length
    Pose from, to;        // of the movement
    bool flipped = false;
    double handle = 0.0;         // rad, handle angle about the bolt now
    double stroke_begin = 0.0;   // rad, where this pull began
    double begin_angle = 0.0;    // rad, of the nut when it came to it
    double free_turn = 0.0;      // rad turned without resistance, loosening
    Vec3 placed{0.0};            // m, how far off the centre it put the tool
    Vec3 bulge{0.0};             // m, how far the reach goes off the straight way
    std::vector<Pose> stations;  // that it still goes to after `to`, the last first
    double room = 0.0;           // rad that the handle may swing in this pull
    bool holds_wrench = false;
    double caught = 0.0;  // s that the wrench has been kept from where the hand means to be
    int bumps = 0;        // times in a row that it was
    int misses = 0;       // times in a row that the jaw did not slide on
    Arm arm;
    Pose hand;                 // where it is
    bool gripped = false;      // it had hold of a nut in the tick before
    bool turned_back = false;  // it was caught and means to be where the wrench is
    Pose rest;                 // before the assembly, where the wrench lies and nothing is in the way

    // What can be seen at this tick.
    const servo::Setup* setup = nullptr;
    const servo::State* state = nullptr;
    const lesson::Lesson* lesson = nullptr;

    Mind(const Profile& p, std::uint64_t seed, double dt)
        : profile(p), random(seed, 7001), tremor(random), nerves(p.reaction, dt) {}

    [[nodiscard]] const servo::NutPlace& nut() const { return setup->nuts[intent.joint]; }
    [[nodiscard]] const joint::JointState& joint() const { return state->joints[intent.joint]; }
    [[nodiscard]] const servo::Touch* obstacles() const { return state->touch ? &*state->touch : nullptr; }
    [[nodiscard]] double elapsed() const { return time - begun; }
    [[nodiscard]] double progress() const { return length > 0.0 ? elapsed() / length : 1.0; }
    [[nodiscard]] bool over() const { return progress() >= 1.0; }
    [[nodiscard]] bool step_is_past() const { return intent.step != lesson->current; }
    [[nodiscard]] Vec3 off_centre(double deviation) {
        return Vec3(random.normal(), random.normal(), random.normal()) * deviation;
    }

    void enter(Phase next, double seconds = 0.0) {
        phase = next;
        begun = time;
        length = seconds;
    }

    // The tool over the nut, `above` it.
    [[nodiscard]] Pose at_nut(double above) const {
        return {servo::nut_centre(nut(), joint().nut.angle) + nut().axis * above + placed,
                orientation_of(nut(), handle, flipped)};
    }

    void lift_off(const Pose& pose, double seconds) {
        from = pose;
        to = at_nut(hover);
        enter(Phase::lift, seconds);
    }

    [[nodiscard]] const lesson::Step* next_step() const;
    void decide();
    void choose_joint_and_goal(const lesson::Step& due);
    void choose_grip_angle();
    void plan_reach();
    bool goes_on(Phase reaching);
    [[nodiscard]] double reach_time() const;
    void take_hold();
    void notice_caught(const Pose& meant, const Pose& wrench);
    void pull(const Feeling& felt);
    void spin(const Feeling& felt);
    Pose move(const Feeling& felt, Grip& grip);
};

// The step to work on. In assessment nobody says that a joint is not tight enough: who believes to be done
// goes on.
const lesson::Step* Operator::Mind::next_step() const {
    const lesson::Step* due = lesson->due();
    const bool believes = intent.finished && !intent.wrong && intent.step == lesson->current;
    const bool left_alone = lesson->mode == lesson::Mode::assessment && believes;
    if (!left_alone) return due;
    return lesson->current + 1 < lesson->steps.size() ? due + 1 : nullptr;  // after the last one: hand in
}

// Which step is due, and how this person will go about it.
void Operator::Mind::decide() {
    const lesson::Step* due = next_step();
    if (due == nullptr) {
        enter(Phase::done);
        return;
    }
    // A pull that only ran out of arm goes on with the same intent.
    if (step_is_past() || intent.wrong || intent.finished) choose_joint_and_goal(*due);
    if (intent.fingers) {
        flipped = false;
        handle = random.uniform(0.0, 2.0 * pi);
    } else {
        choose_grip_angle();
    }
    placed = off_centre(profile.position_noise * (intent.fingers ? 3.0 : 1.0));
    // Among obstacles another tool is laid down or taken up where there are none.
    if (obstacles() != nullptr && holds_wrench == intent.fingers && from.position != rest.position) {
        to = rest;
        plan_reach();
        enter(Phase::fetch, stations.empty() ? profile.reach_time : reach_time());
        return;
    }
    holds_wrench = !intent.fingers;
    to = at_nut(hover);
    plan_reach();
    enter(Phase::reach, reach_time() * random.uniform(0.85, 1.2));
}

void Operator::Mind::choose_joint_and_goal(const lesson::Step& due) {
    const bool retry = &due == lesson->due() && !step_is_past();
    const int tries = retry ? intent.tries + 1 : 0;
    const std::size_t joints = setup->nuts.size();
    intent = {};
    intent.step = static_cast<std::size_t>(&due - lesson->steps.data());
    intent.tries = tries;
    intent.joint = due.joint;
    const double drag = lesson->assembly->joints[due.joint].design.prevailing_torque;
    intent.until_seated = due.kind == StepKind::run_down;
    intent.fingers = intent.until_seated && drag < finger_drag * setup->finger_torque(setup->nuts[due.joint]);
    intent.loosening = due.kind == StepKind::loosen;
    intent.checks = due.kind == StepKind::recheck;
    begin_angle = joint().nut.angle;
    free_turn = 0.0;
    if (!retry && !intent.fingers && joints > 1 && random.chance(profile.wrong_joint)) {
        intent.wrong = true;
        intent.joint = (due.joint + 1 + random.bits() % (joints - 1)) % joints;
    }
    double stop = 1.0 + profile.torque_bias + profile.torque_noise * random.normal();
    if (!retry && random.chance(profile.stops_early)) stop *= 0.75;
    if (random.chance(profile.overdoes)) stop *= 1.25;
    stop += 0.04 * tries;  // it was not enough: a little more
    intent.goal = (intent.wrong ? 0.3 : 1.0) * due.torque * stop;
    if (intent.until_seated) intent.goal = 1.3 * drag + 2.0;
    // Tightening into yield: who can feel it goes on until it comes, and knows the torques to reach and not
    // to pass.
    const content::Specification& spec = lesson->assembly->joints[intent.joint].spec;
    const bool in_full = due.kind == StepKind::tighten && due.fraction > 0.999;
    intent.stops_at_yield = !intent.wrong && in_full && spec.strategy == content::Strategy::yield &&
                            random.chance(profile.feels_yield);
    intent.least = spec.torque.low;
    if (intent.stops_at_yield)
        intent.goal = spec.torque.high * (std::min(0.98, stop - 0.04 * tries) + 0.04 * tries);
}

// The handle ends its stroke about as far beyond the trainee's side as it began before it.
void Operator::Mind::choose_grip_angle() {
    const double sign = intent.loosening ? -1.0 : 1.0;
    // Where it does not get on again and again, it tries from another side.
    const double aside = misses > patient_misses ? random.uniform(-1.0, 1.0) * pi : 0.0;
    const GripAngle grip = choose_grip(*setup, obstacles(), intent.joint, joint().nut.angle,
                                       0.5 * pi - 0.5 * sign + aside, sign, profile.stroke);
    handle = grip.handle + profile.angle_noise * random.normal();
    flipped = grip.flipped;
    room = grip.room;
}

// Which way to go: as ever, or as the obstacles that can be seen make it.
void Operator::Mind::plan_reach() {
    const double rise = std::min(arc, 0.3 * glm::distance(from.position, to.position));
    bulge = rise * nut().axis;
    stations.clear();
    if (obstacles() == nullptr) return;
    Way way = way_round(*setup, *obstacles(), from, to, nut().axis, rise + 0.05 * std::min(bumps, 5));
    bulge = way.bulge;
    if (way.stations.empty()) return;
    stations.push_back(to);
    stations.insert(stations.end(), way.stations.rbegin(), way.stations.rend());
    to = stations.back();
    stations.pop_back();
}

// A short way takes less time than a long one, but never none (Fitts).
double Operator::Mind::reach_time() const {
    const double far = std::min(1.0, 0.35 + glm::distance(from.position, to.position) / 0.3);
    const double round = obstacles() != nullptr ? 1.0 + 2.0 * glm::length(bulge) : 1.0;
    return far * profile.reach_time * round;
}

bool Operator::Mind::goes_on(Phase reaching) {
    from = to;
    if (stations.empty()) return false;
    to = stations.back();
    stations.pop_back();
    enter(reaching, reach_time());
    return true;
}

// The jaw is on the nut: where the wrench is, there the hand means it to be from now on.
void Operator::Mind::take_hold() {
    const Vec3 x = hand.orientation * Vec3(1, 0, 0);
    handle += wrap(-std::atan2(glm::dot(x, nut().e2), glm::dot(x, nut().e1)) - handle, 2.0 * pi);
    // Along the bolt it goes on: a jaw that only just has the nut is not on it yet.
    const Vec3 off = hand.position - servo::nut_centre(nut(), joint().nut.angle);
    placed = off + nut().axis * glm::dot(nut().axis, placed - off);
}

// A wrench that is caught on something is taken back and up, and the next way goes higher.
void Operator::Mind::notice_caught(const Pose& meant, const Pose& wrench) {
    const bool on_the_way =
        phase == Phase::reach || phase == Phase::fetch || phase == Phase::lift || phase == Phase::think;
    if (!on_the_way || glm::distance(meant.position, wrench.position) < caught_at) {
        caught = 0.0;
        if (phase == Phase::lower) bumps = 0;
        return;
    }
    caught += setup->dt;
    if (caught < caught_after) return;
    caught = 0.0;
    ++bumps;
    from = wrench;
    const Vec3 back = rest.position - wrench.position;
    to = {wrench.position + retreat * (nut().axis + 0.3 * static_cast<double>(std::min(bumps, 5)) * back /
                                                        (1e-3 + glm::length(back))),
          wrench.orientation};
    turned_back = true;
    enter(Phase::lift, 0.6);
}

// A hand on a wrench controls force: it lets the torque grow at a rate, slower towards the goal, and follows
// the nut when it moves. dT/dt = K (hand speed − nut speed) turns that into how fast the handle goes.
void Operator::Mind::pull(const Feeling& felt) {
    const double load = std::abs(felt.torque);
    const double nut_speed = std::abs(joint().nut.speed);
    const double scale = intent.loosening ? setup->wrench.stiffness * to_radians(1.0) : intent.goal;
    const double missing = intent.loosening ? 1.0 : 1.0 - load / intent.goal;
    const double rate = scale * std::max(profile.final_rate, profile.load_rate * missing);
    const double fastest = profile.pull_speed * (intent.checks ? 0.2 : 1.0);
    const double speed =
        std::min(fastest * std::min(1.0, elapsed() / 0.15), rate / setup->wrench.stiffness + nut_speed);
    handle += (intent.loosening ? -1.0 : 1.0) * speed * setup->dt;

    if (intent.loosening) {
        free_turn = load < no_torque ? free_turn + nut_speed * setup->dt : 0.0;
        intent.finished = free_turn > to_radians(loose_free);
    } else {
        // It allows for the torque that will still come while it reacts.
        const double coming = profile.anticipation * profile.reaction * std::max(felt.torque_rate, 0.0);
        intent.finished = load + coming >= intent.goal ||
                          (intent.stops_at_yield && felt.yields && load >= intent.least) ||
                          (intent.checks && joint().nut.angle - begin_angle > seen_turn) ||
                          (intent.until_seated && felt.seated);
    }
    if (intent.finished || std::abs(handle - stroke_begin) >= room) enter(Phase::ease, unwinding_time);
}

void Operator::Mind::spin(const Feeling& felt) {
    handle += profile.spin_speed * setup->dt * minimum_jerk(elapsed() / 0.1);
    intent.finished = felt.torque > seated_share * setup->finger_torque(nut());
    if (intent.finished || handle - stroke_begin > to_radians(spin_stroke))
        enter(Phase::spin_back, intent.finished ? 0.3 : 0.12);
}

// Where the tool goes in this tick, and with which grip.
Pose Operator::Mind::move(const Feeling& felt, Grip& grip) {
    const Grip own = intent.fingers ? Grip::fingers : Grip::wrench;
    Pose pose = from;
    switch (phase) {
        case Phase::think:
            if (over()) decide();
            break;
        case Phase::fetch:
            pose = along(from, to, minimum_jerk(progress()), bulge);
            if (!over() || goes_on(Phase::fetch)) break;
            holds_wrench = !intent.fingers;
            enter(Phase::think, 0.2);
            break;
        case Phase::reach:
            pose = along(from, to, minimum_jerk(progress()), bulge);
            if (!over() || goes_on(Phase::reach)) break;
            enter(Phase::lower, profile.placing_time * random.uniform(0.8, 1.3));
            break;
        case Phase::lower:
            pose = along(from, at_nut(0.0), minimum_jerk(progress()), Vec3(0.0));
            if (over()) enter(Phase::settle, 0.12);
            break;
        case Phase::settle:
            grip = own;
            pose = at_nut(0.0);
            if (state->engagement.joint == static_cast<int>(intent.joint)) {
                stroke_begin = handle;
                misses = 0;
                enter(intent.fingers ? Phase::spin : Phase::pull);
            } else if (over()) {
                // It does not slide on: place it again and turn it a little, as anybody would.
                ++misses;
                if (obstacles() != nullptr && !intent.fingers) {
                    lift_off(pose, 0.2);
                    break;
                }
                placed = off_centre(0.7 * profile.position_noise);
                choose_grip_angle();
                enter(Phase::settle, 0.15);
            }
            break;
        case Phase::pull:
            grip = own;
            pull(felt);
            pose = at_nut(0.0);
            if (state->engagement.joint != static_cast<int>(intent.joint))
                lift_off(pose, 0.3);  // it slipped off
            break;
        case Phase::ease:
            grip = own;
            handle -= joint().torque / setup->wrench.stiffness * std::min(1.0, setup->dt / 0.04) *
                      std::min(1.0, elapsed() / 0.03);
            pose = at_nut(0.0);
            if (over()) lift_off(pose, 0.25);
            break;
        case Phase::lift: {
            pose = along(from, to, minimum_jerk(progress()), Vec3(0.0));
            if (!over()) break;
            from = to;
            const bool done = intent.finished || step_is_past();
            enter(Phase::think, done ? profile.pause * random.uniform(0.3, 1.7) : 0.05);
            break;
        }
        case Phase::spin:
            grip = own;
            spin(felt);
            pose = at_nut(0.0);
            break;
        case Phase::spin_back:  // open the fingers, turn the hand back, take hold again
            if (!intent.finished) handle -= to_radians(spin_stroke) / length * setup->dt;
            pose = at_nut(0.0);
            if (!over()) break;
            if (intent.finished || step_is_past())
                lift_off(pose, 0.3);
            else
                enter(Phase::settle, 0.05);
            break;
        case Phase::done:
            break;
    }
    return pose;
}

Operator::Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup)
    : mind_(std::make_unique<Mind>(profile, seed, setup.dt)) {
    Vec3 centre(0.0);
    for (const servo::NutPlace& nut : setup.nuts) centre += nut.seat / static_cast<double>(setup.nuts.size());
    mind_->from.position = centre + Vec3(0.0, 0.3, 0.4);  // the hand rests in front of the assembly
    mind_->to = mind_->rest = mind_->hand = mind_->from;
}

Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;
Operator::~Operator() = default;

servo::Input Operator::act(const servo::Setup& setup, const servo::State& state,
                           const lesson::Lesson& lesson) {
    Mind& m = *mind_;
    m.setup = &setup;
    m.state = &state;
    m.lesson = &lesson;
    m.time += setup.dt;

    servo::Input input;
    input.enabled = true;
    const lesson::Step* due = lesson.due();
    if (due != nullptr && lesson.guides) input.guide = static_cast<std::int16_t>(due->joint);
    // What has hold of a nut stays; a hand in the air is moved by what it feels, and by nothing else.
    // While it still lowers the wrench the jaw may have the nut, but the hand does not hold yet.
    const bool grips = state.engagement.joint >= 0 && m.phase != Phase::lower;
    const bool takes = grips && !m.gripped;
    if (takes && state.engagement.joint == static_cast<int>(m.intent.joint)) m.take_hold();
    Pose pose = m.move(m.nerves.feel(m.joint()), input.grip);
    if (m.phase != Phase::done) {
        pose.position += m.tremor.at(m.time) * m.profile.tremor;
        if (m.phase == Phase::pull) {
            const double sway = m.profile.tremor_torsion * m.tremor.torsion(m.time);
            pose.orientation = orientation_of(m.nut(), m.handle + sway, m.flipped);
        }
    }
    // It changed its mind, not its place.
    if (grips != m.gripped || m.turned_back) take_up(m.arm, m.hand, pose);
    m.gripped = grips;
    m.turned_back = false;
    const force::OutputState& felt = state.output.output;
    m.hand = follow(m.profile.hand, m.arm, pose, {felt.force, felt.torque}, grips, setup.dt);
    if (m.obstacles() != nullptr && m.holds_wrench) {
        input.grip = Grip::wrench;
        if (m.obstacles()->in_hand) {
            const Pose& wrench = m.obstacles()->god_object.tool;
            m.notice_caught(pose, wrench);
            if (grips) m.hand = give_way(m.hand, wrench);
        }
    }
    input.device = sample_of(m.hand);
    return input;
}

}  // namespace bolt::operators
