#include "game/trainees/pull.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::trainees {

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
