#include "game/trainees/behaviour.hpp"

#include <algorithm>
#include <cmath>

#include "game/motion/path_planning.hpp"

namespace bolt::trainees {

using lesson::StepKind;

const lesson::Step* next_step(const lesson::Lesson& lesson, const Intent& intent) {
    const lesson::Step* due = lesson.due();
    const bool believes = intent.finished && !intent.wrong && intent.step == lesson.current;
    const bool left_alone = lesson.mode == lesson::Mode::assessment && believes;
    if (!left_alone) return due;
    return lesson.current + 1 < lesson.steps.size() ? due + 1 : nullptr;  // after the last one: hand in
}

Intent intend(const Profile& profile, Random& random, const servo::Setup& setup, const lesson::Lesson& lesson,
              const lesson::Step& due, const Intent& before) {
    const bool retry = &due == lesson.due() && before.step == lesson.current;
    const std::size_t joints = setup.nuts.size();
    Intent intent;
    intent.step = static_cast<std::size_t>(&due - lesson.steps.data());
    intent.tries = retry ? before.tries + 1 : 0;
    intent.joint = due.joint;
    const double drag = lesson.assembly->joints[due.joint].design.prevailing_torque;
    intent.until_seated = due.kind == StepKind::run_down;
    intent.fingers = lesson::by_fingers(*lesson.assembly, due, setup.finger_torque(setup.nuts[due.joint]));
    intent.loosening = due.kind == StepKind::loosen;
    intent.checks = due.kind == StepKind::recheck;
    if (!retry && !intent.fingers && joints > 1 && random.chance(profile.wrong_joint)) {
        intent.wrong = true;
        intent.joint = (due.joint + 1 + random.bits() % (joints - 1)) % joints;
    }
    // With a torque wrench nobody needs to feel torques: who means to stop where one should waits for the
    // click.
    intent.until_click = !intent.wrong && lesson::setting(lesson) > 0.0;
    double stop = 1.0 + profile.torque_bias + profile.torque_noise * random.normal();
    if (!retry && random.chance(profile.stops_early)) {
        stop *= 0.75;
        intent.until_click = false;
    }
    if (random.chance(profile.overdoes)) {
        stop *= 1.25;
        intent.until_click = false;
    }
    stop += 0.04 * intent.tries;  // it was not enough: a little more
    intent.goal = (intent.wrong ? 0.3 : 1.0) * due.torque * stop;
    if (intent.until_seated) intent.goal = 1.3 * drag + 2.0;
    // Tightening into yield: who can feel it goes on until it comes, and knows the torques to reach and not
    // to pass.
    const content::Specification& spec = lesson.assembly->joints[intent.joint].spec;
    const bool in_full = due.kind == StepKind::tighten && due.fraction > 0.999;
    intent.stops_at_yield = !intent.wrong && in_full && spec.strategy == content::Strategy::yield &&
                            random.chance(profile.feels_yield);
    intent.least = spec.torque.low;
    if (intent.stops_at_yield)
        intent.goal = spec.torque.high * (std::min(0.98, stop - 0.04 * intent.tries) + 0.04 * intent.tries);
    return intent;
}

namespace {

constexpr double turning_rise = 0.03;  // m that a wrench is lifted to be turned over, beside its bolt
constexpr double arc = 0.05;           // m, height of a reach between joints, at most
constexpr double caught_at = 0.02;     // m that a wrench stays behind the hand's meaning: it is caught
constexpr double caught_after = 0.5;   // s
constexpr double retreat = 0.06;       // m
constexpr int patient_misses = 3, patient_pulls = 3, most_higher = 4;
constexpr double higher_by = 1e-3;  // m

// A glance, and a head that turns. Chosen.
constexpr double glance = 0.3;                   // s
constexpr double head_speed = to_radians(60.0);  // rad/s
// A key is pressed, and the picture glides: after five times 70 ms (view::Glide) it is there.
constexpr double gliding = 0.35;  // s

Vec3 unit(const Vec3& v) { return v / (1e-3 + glm::length(v)); }

// Which way to go: as ever, or as the obstacles that can be seen make it.
void plan_reach(Mind& m) {
    const Quat turn = glm::normalize(m.to.orientation * glm::conjugate(m.from.orientation));
    const double over = glm::length(rotation_vector(turn)) / pi;
    const double rise =
        std::max(turning_rise * over, std::min(arc, 0.3 * glm::distance(m.from.position, m.to.position)));
    m.bulge = rise * m.nut().axis;
    m.stations.clear();
    if (m.obstacles() == nullptr) return;
    motion::Way way = motion::way_round(*m.setup, *m.obstacles(), m.from, m.to, m.nut().axis,
                                        rise + 0.05 * std::min(m.bumps, 5));
    m.bulge = way.bulge;
    if (way.stations.empty()) return;
    m.stations.push_back(m.to);
    m.stations.insert(m.stations.end(), way.stations.rbegin(), way.stations.rend());
    m.to = m.stations.back();
    m.stations.pop_back();
}

// s until it sees more of the place that the wrench is to go to. Nothing is hidden where nothing is modelled,
// and fingers find a nut by themselves. Help with the view is asked for first; what it does not show to
// somebody's content is looked for as without it.
double look_for_nut(Mind& m) {
    m.looks_from = m.sight.eye;
    if (m.obstacles() == nullptr || m.intent.fingers) return 0.0;
    m.placed = Vec3(0.0);
    const Pose wrench = m.at_nut(m.above);
    const servo::ToolContact& touch = *m.obstacles();
    double seconds = 0.0;
    const auto content = [&] {
        return motion::place_seen(m.sight, *m.setup, touch, m.intent.joint, wrench, m.sight.eye) >=
               m.profile.content;
    };
    if (m.view_help && !content()) {
        const Vec3 nut = servo::nut_centre(m.nut(), m.joint().nut.angle);
        m.sight.eye = m.looks_from = m.view_help({*m.setup, touch, m.intent.joint, nut, wrench, m.sight.eye});
        seconds = glance + gliding;
    }
    const auto better =
        motion::look_round(m.sight, *m.setup, touch, m.intent.joint, wrench, m.profile.content, m.random);
    if (!better) return seconds;
    m.looks_from = better->eye;
    return seconds + better->glances * glance + better->turn / head_speed;
}

// How far off the centre it puts the tool, from what it will see there.
Vec3 place(Mind& m) {
    if (m.intent.fingers) return m.off_centre(3.0 * m.profile.position_noise);
    const double seen = m.obstacles() == nullptr
                            ? 1.0
                            : motion::place_seen(m.sight, *m.setup, *m.obstacles(), m.intent.joint,
                                                 m.at_nut(m.above), m.looks_from);
    // A head that lies against something beside the nut turns it with difficulty: the next time it sits
    // higher.
    const Vec3 higher = higher_by * std::clamp(m.vain - patient_pulls, 0, most_higher) * m.nut().axis;
    return higher + m.off_centre(motion::placing_noise(m.profile.position_noise, seen, m.misses));
}

// A short way takes less time than a long one, but never none (Fitts).
double reach_time(const Mind& m) {
    const double far = std::min(1.0, 0.35 + glm::distance(m.from.position, m.to.position) / 0.3);
    const double round = m.obstacles() != nullptr ? 1.0 + 2.0 * glm::length(m.bulge) : 1.0;
    return far * m.profile.reach_time * round;
}

}  // namespace

void decide(Mind& m) {
    const lesson::Step* due = next_step(*m.lesson, m.intent);
    if (due == nullptr) {
        m.enter(Phase::done);
        return;
    }
    // A pull that only ran out of arm goes on with the same intent.
    if (m.step_is_past() || m.intent.wrong || m.intent.finished) {
        m.begin_angle = m.state->joints[due->joint].nut.angle;
        m.free_turn = 0.0;
        m.intent = intend(m.profile, m.random, *m.setup, *m.lesson, *due, m.intent);
    }
    if (m.intent.fingers) {
        m.flipped = false;
        m.handle = m.random.uniform(0.0, 2.0 * pi);
        m.above = hover;
    } else {
        choose_grip_angle(m);
    }
    const double looking = look_for_nut(m);
    m.placed = place(m);
    // Among obstacles another tool is laid down or taken up where there are none.
    const bool other_tool = m.holds_wrench == m.intent.fingers;
    if (m.obstacles() != nullptr && other_tool && m.from.position != m.rest.position) {
        m.to = m.rest;
        plan_reach(m);
        m.enter(Phase::fetch, m.stations.empty() ? m.profile.reach_time : reach_time(m));
        return;
    }
    m.holds_wrench = !m.intent.fingers;
    if (looking > 0.0) {
        m.enter(Phase::look, looking);
        return;
    }
    set_off(m);
}

void set_off(Mind& m) {
    m.sight.eye = m.looks_from;
    // A hand that was drawn from where it meant to be goes on from where it is.
    if (m.obstacles() != nullptr) {
        m.from = m.hand;
        m.turned_back = true;
    }
    m.to = m.at_nut(m.above);
    plan_reach(m);
    m.enter(Phase::reach, reach_time(m) * m.random.uniform(0.85, 1.2));
}

void choose_grip_angle(Mind& m) {
    const double sign = m.intent.loosening ? -1.0 : 1.0;
    // Where it does not get on again and again, or its pulls come to nothing, it tries from another side.
    const double aside =
        m.misses > patient_misses || m.vain > patient_pulls ? m.random.uniform(-1.0, 1.0) * pi : 0.0;
    const motion::GripAngle grip =
        motion::choose_grip(*m.setup, m.obstacles(), m.intent.joint, m.joint().nut.angle,
                            0.5 * pi - 0.5 * sign + aside, sign, m.profile.stroke);
    m.handle = grip.handle + m.profile.angle_noise * m.random.normal();
    m.flipped = grip.flipped;
    m.room = grip.room;
    m.above = m.obstacles() == nullptr ? hover
                                       : motion::room_above(*m.setup, *m.obstacles(), m.intent.joint,
                                                            m.joint().nut.angle, grip, hover);
}

bool goes_on(Mind& m, Phase reaching) {
    m.from = m.to;
    if (m.stations.empty()) return false;
    m.to = m.stations.back();
    m.stations.pop_back();
    m.enter(reaching, reach_time(m));
    return true;
}

void lift_off(Mind& m, const Pose& pose, double seconds) {
    m.from = pose;
    m.to = m.at_nut(m.above);
    m.enter(Phase::lift, seconds);
}

void take_hold(Mind& m) {
    const servo::NutGeometry& nut = m.nut();
    const Vec3 x = m.hand.orientation * Vec3(1, 0, 0);
    m.handle += wrap(-std::atan2(glm::dot(x, nut.e2), glm::dot(x, nut.e1)) - m.handle, 2.0 * pi);
    // Along the bolt it goes on: a jaw that only just has the nut is not on it yet.
    const Vec3 off = m.hand.position - servo::nut_centre(nut, m.joint().nut.angle);
    m.placed = off + nut.axis * glm::dot(nut.axis, m.placed - off);
}

void notice_caught(Mind& m, const Pose& meant, const Pose& wrench) {
    const bool on_the_way = m.phase == Phase::reach || m.phase == Phase::fetch || m.phase == Phase::lift ||
                            m.phase == Phase::think;
    if (!on_the_way || glm::distance(meant.position, wrench.position) < caught_at) {
        m.caught = 0.0;
        if (m.phase == Phase::lower) m.bumps = 0;
        return;
    }
    m.caught += m.setup->dt;
    if (m.caught < caught_after) return;
    m.caught = 0.0;
    ++m.bumps;
    m.from = wrench;
    // By turns up and back, and aside from what it was pushed against: a corner that hooks into a thread does
    // not come out along the bolt.
    const Vec3 up = m.nut().axis, back = m.rest.position - wrench.position;
    Vec3 aside = wrench.position - meant.position;
    aside -= up * glm::dot(up, aside);
    const Vec3 way = m.bumps % 2 == 1 ? up + 0.3 * static_cast<double>(std::min(m.bumps, 5)) * unit(back)
                                      : 0.3 * up + unit(aside);
    m.to = {wrench.position + retreat * way, wrench.orientation};
    m.turned_back = true;
    m.enter(Phase::lift, 0.6);
}

namespace {

constexpr double seated_share = 0.5;           // of the fingers' speed: a nut that is slower sits
constexpr double spin_stroke = 200.0;          // degrees of one finger twist
constexpr double loose_free = 40.0;            // degrees turned at next to no torque: the nut is free
constexpr double no_torque = 1.0;              // N·m, next to none at a wrench
constexpr double seen_turn = to_radians(0.5);  // of a nut that can be seen
constexpr double never_clicks = 1.3;           // of its goal: a wrench that has not clicked by then
constexpr double worth_a_pull = to_radians(1.0);
constexpr double tight_share = 0.7;  // of the goal, that a pull has come to

constexpr double unwinding_time = 0.18;  // s to let the wrench spring back before it comes off

}  // namespace

// A hand on a wrench controls force: it lets the torque grow at a rate, slower towards the goal, and follows
// the nut when it moves. dT/dt = K (hand speed − nut speed) turns that into how fast the handle goes.
void pull(Mind& m, const Feeling& felt) {
    const Profile& profile = m.profile;
    Intent& intent = m.intent;
    const double load = std::abs(felt.torque);
    const double nut_speed = std::abs(m.joint().nut.speed);
    const double stiffness = m.setup->wrench.stiffness, dt = m.setup->dt;
    const double scale = intent.loosening ? stiffness * to_radians(1.0) : intent.goal;
    // It allows for the torque that will still come while it reacts, in slowing down as in stopping: a hand
    // that slowed down by what it feels late alone would swing past its goal.
    const double coming = profile.anticipation * profile.reaction * std::max(felt.torque_rate, 0.0);
    const double missing = intent.loosening ? 1.0 : 1.0 - (load + coming) / intent.goal;
    const double rate = scale * std::max(profile.final_rate, profile.load_rate * missing);
    const double fastest = profile.pull_speed * (intent.checks ? 0.2 : 1.0);
    const double speed = std::min(fastest * std::min(1.0, m.elapsed() / 0.15), rate / stiffness + nut_speed);
    m.handle += (intent.loosening ? -1.0 : 1.0) * speed * dt;

    if (intent.loosening) {
        m.free_turn = load < no_torque ? m.free_turn + nut_speed * dt : 0.0;
        intent.finished = m.free_turn > to_radians(loose_free);
    } else {
        intent.finished = (intent.until_click && felt.clicked) ||
                          load + coming >= (intent.until_click ? never_clicks : 1.0) * intent.goal ||
                          (intent.stops_at_yield && felt.yields && load >= intent.least) ||
                          (intent.checks && m.joint().nut.angle - m.begin_angle > seen_turn);
    }
    const bool no_room = std::abs(m.handle - m.stroke_begin) >= m.room;
    if (!intent.finished && !no_room) return;
    // A handle that comes up against something feels like a nut that is tight, and the nut has not turned.
    const bool turned = std::abs(m.joint().nut.angle - m.nut_at_stroke) > worth_a_pull;
    const bool tight = std::abs(m.joint().torque) > tight_share * intent.goal;
    m.vain = turned || tight ? 0 : m.vain + 1;

    m.enter(Phase::ease, unwinding_time);
}

void spin(Mind& m, const Feeling& felt) {
    m.handle += m.profile.spin_speed * m.setup->dt * motion::minimum_jerk(m.elapsed() / 0.1);
    // Next to a wrench's torques a device does not let fingertips feel theirs: that the nut sits is seen.
    const bool under_way = m.elapsed() > 0.1 + m.profile.reaction;
    m.intent.finished = under_way && felt.nut_speed < seated_share * m.profile.spin_speed;
    if (m.intent.finished || m.handle - m.stroke_begin > to_radians(spin_stroke))
        m.enter(Phase::spin_back, m.intent.finished ? 0.3 : 0.12);
}

void ease(Mind& m) {
    const double wound = m.joint().torque / m.setup->wrench.stiffness + m.state->engagement.swung;
    m.handle -= wound * std::min(1.0, m.setup->dt / 0.04) * std::min(1.0, m.elapsed() / 0.03);
}

void spin_back(Mind& m) {
    if (!m.intent.finished) m.handle -= to_radians(spin_stroke) / m.length * m.setup->dt;
}

}  // namespace bolt::trainees
