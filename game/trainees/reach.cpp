#include "game/trainees/reach.hpp"

#include <algorithm>
#include <cmath>

#include "game/motion/path_planning.hpp"

namespace bolt::trainees {

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

}  // namespace bolt::trainees
