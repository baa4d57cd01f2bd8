#include "game/trainer/mouse_hand.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "game/motion/path_planning.hpp"

namespace bolt::trainer {

namespace {

using motion::along;
using motion::minimum_jerk;

constexpr double hover = 0.045;                     // m above a nut, where a bolt's end is below the wrench
constexpr double retreat = 0.15;                    // m, from where the wrench lies, up and to the front
constexpr double hand_speed = 0.45;                 // m/s, of a reach, at most somewhat more than twice that
constexpr double shortest = 0.25;                   // s
constexpr double lowering = 0.35, lifting = 0.25;   // s
constexpr double patience = 0.6;                    // s on the nut without getting hold of it
constexpr double caught = 0.05;                     // m that the wrench is away from the nut it should be on
constexpr double higher = 0.05;                     // m, with every miss
constexpr double unwinding = 0.15;                  // s
constexpr double twist = to_radians(200.0);         // of fingers, before they have to go back
constexpr double twist_speed = to_radians(540.0);   // rad/s, the fastest
constexpr double back_time = 0.15;                  // s
constexpr double stroke = to_radians(60.0);         // that a pull would like to have room for
constexpr double fastest_pull = to_radians(150.0);  // rad/s
constexpr double stronger = 2.0;  // a drag turns the handle by a third at the greatest torque: a hand strains

const servo::NutGeometry& nut_of(const MouseHand& hand, const servo::Setup& setup) {
    return setup.nuts[hand.nut.value()];
}

Pose at_nut(const MouseHand& hand, const servo::Setup& setup, const servo::State& state, double above) {
    const servo::NutGeometry& nut = nut_of(hand, setup);
    const double angle = state.joints[hand.nut.value()].nut.angle;
    return {servo::nut_centre(nut, angle) + above * nut.axis,
            motion::orientation_of(nut, hand.handle, hand.flipped)};
}

bool has_hold(const MouseHand& hand, const servo::State& state) {
    return hand.nut && state.engagement.joint == static_cast<int>(*hand.nut);
}

void go(MouseHand& hand, const Pose& to, double seconds, Doing doing) {
    hand.from = hand.pose;
    hand.to = to;
    hand.bulge = Vec3(0.0);
    hand.time = 0.0;
    hand.length = seconds;
    hand.doing = doing;
}

double reach_time(const Pose& from, const Pose& to, const Vec3& bulge) {
    const double way = glm::distance(from.position, to.position) + 2.0 * glm::length(bulge);
    const double round =
        glm::length(rotation_vector(glm::normalize(to.orientation * glm::conjugate(from.orientation))));
    return std::max({shortest, way / hand_speed, round / 4.0});
}

// A way that meets nothing that can be seen; a bare hand meets nothing.
void reach(MouseHand& hand, const Pose& to, MouseHand::Then then, const servo::Setup& setup,
           const servo::State& state, const Vec3& up) {
    const double far = glm::distance(hand.pose.position, to.position);
    motion::Way way{(std::min(0.05, 0.3 * far) + higher * std::min(hand.misses, 5)) * up, {}};
    if (hand.wrench && state.tool_contact)
        way = motion::way_round(setup, *state.tool_contact, hand.pose, to, up, glm::length(way.bulge));
    hand.stations.assign(1, to);
    hand.stations.insert(hand.stations.end(), way.stations.rbegin(), way.stations.rend());
    const Pose first = hand.stations.back();
    hand.stations.pop_back();
    go(hand, first, reach_time(hand.pose, first, way.bulge), Doing::reaching);
    hand.bulge = way.bulge;
    hand.then = then;
}

// From which side the handle goes on the nut.
void choose_side(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    const double sign = hand.loosens ? -1.0 : 1.0;
    const servo::NutGeometry& nut = nut_of(hand, setup);
    // Towards whoever works, in the middle of the pull.
    const Vec3 out = hand.rest.position - nut.seat;
    const double aside = (hand.misses % 2 == 1 ? 1.0 : -1.0) * to_radians(60.0) * (hand.misses / 2);
    const double wanted =
        -std::atan2(glm::dot(out, nut.e2), glm::dot(out, nut.e1)) - 0.5 * sign * stroke + aside;
    const auto grip = motion::choose_grip(setup, state.tool_contact ? &*state.tool_contact : nullptr,
                                          *hand.nut, state.joints[*hand.nut].nut.angle, wanted, sign, stroke);
    hand.handle = grip.handle;
    hand.flipped = grip.flipped;
    hand.room = grip.room;
    hand.above = state.tool_contact ? motion::room_above(setup, *state.tool_contact, *hand.nut,
                                                         state.joints[*hand.nut].nut.angle, grip, hover)
                                    : hover;
}

void go_to_nut(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.turn = 0.0;
    hand.missed = false;
    if (hand.wrench) {
        choose_side(hand, setup, state);
    } else {
        hand.flipped = false;
        hand.handle = 0.0;
        hand.above = hover;
    }
    reach(hand, at_nut(hand, setup, state, hand.above), MouseHand::Then::lower, setup, state,
          nut_of(hand, setup).axis);
}

void lift(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.pose = hand.wrench && state.tool_contact && state.tool_contact->in_hand
                    ? state.tool_contact->god_object.tool
                    : hand.pose;
    Pose up = at_nut(hand, setup, state, hand.above);
    up.orientation = hand.pose.orientation;
    // Caught on the way there: off what holds it, not on through that.
    const servo::NutGeometry& nut = nut_of(hand, setup);
    if (hand.missed && glm::distance(hand.pose.position, nut.seat) > caught)
        up.position = hand.pose.position + hover * nut.axis;
    go(hand, up, lifting, Doing::lifting);
}

// To whoever works, with what it holds.
void withdraw(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.nut.reset();
    const Vec3 up = setup.nuts.empty() ? Vec3(0, 1, 0) : setup.nuts.front().axis;
    const Vec3 nearer = hand.rest * Vec3(0.0, hand.nearer * retreat, 0.0);
    reach(hand, {nearer + retreat * up, hand.rest.orientation}, MouseHand::Then::rest, setup, state, up);
}

void arrive(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    if (!hand.stations.empty()) {
        const Pose next = hand.stations.back();
        hand.stations.pop_back();
        go(hand, next, reach_time(hand.pose, next, Vec3(0.0)), Doing::reaching);
        return;
    }
    hand.doing = Doing::resting;
    switch (hand.then) {
        case MouseHand::Then::rest:
            break;
        case MouseHand::Then::take:
            hand.wrench = true;
            break;
        case MouseHand::Then::lay_down:
            hand.wrench = false;
            break;
        case MouseHand::Then::lower:
            if (hand.held) go(hand, at_nut(hand, setup, state, 0.0), lowering, Doing::lowering);
            break;
    }
}

// The handle goes as far as it was dragged, not faster than an arm, and not further than it has room.
void pull(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    const double torque = std::abs(state.joints[*hand.nut].torque), dt = setup.dt;
    const double greatest = setup.wrench.stiffness * to_radians(2.5);
    const double gain = 1.0 / (1.0 + stronger * torque / greatest);
    const double step = std::clamp(gain * hand.turn, -fastest_pull * dt, fastest_pull * dt);
    hand.turn -= step / gain;
    const double least = hand.begun_at - (hand.loosens ? hand.room : stroke);
    const double most = hand.begun_at + (hand.loosens ? stroke : hand.room);
    const double to = std::clamp(hand.handle + step, least, most);
    if (to != hand.handle + step) hand.turn = 0.0;  // at the end of its room: what is dragged on is lost
    hand.handle = to;
}

void spin(MouseHand& hand, const servo::Setup& setup) {
    hand.handle += twist_speed * hand.spin * setup.dt;
    if (std::abs(hand.handle - hand.begun_at) < twist) return;
    hand.doing = Doing::returning;
    hand.time = 0.0;
    hand.length = back_time;
    hand.twisted_to = hand.handle;
}

void hold(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    const bool on = has_hold(hand, state);
    if (!on) hand.begun_at = hand.handle;
    hand.time = on ? 0.0 : hand.time + setup.dt;
    if (!hand.held) {
        if (hand.wrench && on) {
            hand.doing = Doing::easing;
            hand.time = 0.0;
        } else {
            lift(hand, setup, state);
        }
        return;
    }
    if (hand.time > patience) {  // it slipped off, or did not get on
        hand.missed = true;
        ++hand.misses;
        hand.held = false;
        lift(hand, setup, state);
        return;
    }
    if (!on) return;
    hand.missed = false;
    hand.misses = 0;
    if (hand.wrench)
        pull(hand, setup, state);
    else
        spin(hand, setup);
}

// The hand gives way until the wrench bears nothing.
void ease(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.time += setup.dt;
    hand.handle -= state.joints[*hand.nut].torque / setup.wrench.stiffness * std::min(1.0, setup.dt / 0.03) *
                   std::min(1.0, hand.time / 0.03);
    if (hand.time > unwinding) lift(hand, setup, state);
}

void travel(MouseHand& hand, double dt) {
    hand.time += dt;
    const double done = hand.length > 0.0 ? hand.time / hand.length : 1.0;
    hand.pose = along(hand.from, hand.to, minimum_jerk(done), hand.bulge);
}

}  // namespace

MouseHand make_hand(const Pose& rest, hand::Side side) {
    MouseHand hand;
    hand.rest = rest;
    hand.nearer = side == hand::Side::left ? 1.0 : -1.0;
    // Beside the grip, a little above it.
    hand.pose = {rest * Vec3(0.16, 0.05 * hand.nearer, 0.06), rest.orientation};
    return hand;
}

Hand hand_of(const MouseHand& mouse) {
    Hand hand;
    hand.doing = mouse.doing;
    hand.wrench = mouse.wrench;
    hand.nut = mouse.nut;
    hand.pose = mouse.pose;
    hand.to = mouse.stations.empty() ? mouse.to : mouse.stations.front();
    hand.rest = mouse.rest;
    const bool has = mouse.doing == Doing::holding || mouse.doing == Doing::returning;
    const double turned = has ? mouse.handle - mouse.begun_at : 0.0;
    if (mouse.wrench)
        hand.room = mouse.room - std::abs(turned);
    else
        hand.twisted = turned;
    return hand;
}

void wish(MouseHand& hand, const Wish& w, const servo::Setup& setup, const servo::State& state) {
    hand.held = w.held;
    hand.spin = std::clamp(w.spin, -1.0, 1.0);
    if (hand.doing == Doing::holding) hand.turn += w.turn;
    const bool free = hand.doing == Doing::resting || hand.doing == Doing::reaching;
    hand.next = free || !w.held ? std::nullopt : w.nut ? w.nut : hand.next;
    if (!free) return;
    const Vec3 up = setup.nuts.empty() ? Vec3(0, 1, 0) : setup.nuts.front().axis;
    if (w.retreat) {
        withdraw(hand, setup, state);
    } else if (w.wrench && !hand.wrench) {
        hand.nut.reset();
        reach(hand, hand.rest, MouseHand::Then::take, setup, state, up);
    } else if (w.lay_down && hand.wrench) {
        hand.nut.reset();
        reach(hand, hand.rest, MouseHand::Then::lay_down, setup, state, up);
    } else if (w.nut && *w.nut < setup.nuts.size()) {
        hand.nut = w.nut;
        hand.loosens = w.loosens;
        go_to_nut(hand, setup, state);
    }
}

Pose wrench_on(const Pose& rest, const servo::Setup& setup, const servo::State& state, std::size_t joint,
               bool loosens) {
    MouseHand other = make_hand(rest);

    other.nut = joint;
    other.loosens = loosens;
    choose_side(other, setup, state);
    return at_nut(other, setup, state, 0.0);
}

servo::Input move(MouseHand& hand, const servo::Setup& setup, const servo::State& state) {
    servo::Grip grip = hand.wrench ? servo::Grip::wrench : servo::Grip::none;
    switch (hand.doing) {
        case Doing::resting:
            break;
        case Doing::reaching:
            travel(hand, setup.dt);
            if (hand.time >= hand.length) arrive(hand, setup, state);
            break;
        case Doing::lowering:
            travel(hand, setup.dt);
            if (hand.time < hand.length) break;
            hand.doing = Doing::holding;
            hand.time = hand.turn = 0.0;
            hand.begun_at = hand.handle;
            break;
        case Doing::holding:
            hold(hand, setup, state);
            if (hand.doing == Doing::holding) hand.pose = at_nut(hand, setup, state, 0.0);
            if (!hand.wrench && hand.doing == Doing::holding) grip = servo::Grip::fingers;
            break;
        case Doing::returning:
            hand.time += setup.dt;
            hand.handle =
                hand.twisted_to + (hand.begun_at - hand.twisted_to) * minimum_jerk(hand.time / hand.length);
            hand.pose = at_nut(hand, setup, state, 0.0);
            if (hand.time < hand.length) break;
            hand.doing = Doing::holding;
            hand.time = 0.0;
            hand.begun_at = hand.handle;
            break;
        case Doing::easing:
            ease(hand, setup, state);
            if (hand.doing == Doing::easing) hand.pose = at_nut(hand, setup, state, 0.0);
            break;
        case Doing::lifting:
            travel(hand, setup.dt);
            if (hand.time < hand.length) break;
            hand.doing = Doing::resting;
            // Caught again and again, it gets out of there: from where it begins all nuts can be reached.
            if (hand.missed && hand.misses > 2 && hand.wrench && state.tool_contact) {
                withdraw(hand, setup, state);
                break;
            }
            if (hand.next && hand.held) {
                hand.nut = std::exchange(hand.next, std::nullopt);
                go_to_nut(hand, setup, state);
            }
            break;
    }
    servo::Input input;
    input.enabled = true;
    input.grip = grip;
    input.device = servo::sample_of(hand.pose);
    return input;
}

}  // namespace bolt::trainer
