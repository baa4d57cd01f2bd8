#include "haptics/station/step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/servo/lead.hpp"

namespace bolt::station {

namespace {

using device::Description;
using device::Sensing;
using device::Told;

constexpr double hung = 0.010;  // s without a tick, less than device::KeeperOptions::stale
// Chosen, of a tool that glides: from 8 cm on with 12 cm/s, slower than somebody who pushes it away.
constexpr force::Guiding gliding{.gain = 0.25, .greatest = 3.0, .torque = 0.2};
constexpr double glide_speed = 0.04;            // m/s for each newton that would lead a hand
constexpr double glide_turn = 3.0;              // rad/s for each N·m; slower than somebody who turns it on
constexpr double most_wound = to_radians(2.5);  // of the wrench, at the greatest torque
constexpr double wheel_fade = 0.05;             // s in which a wheel comes onto a bolt and off it

bool renders(const Description& d) { return renders_force(d) || renders_torque(d); }

// What is new of a device, and how much of a force it may have.
void note(const Description& d, Port& port, const Told& told, double elapsed) {
    port.usable = told.usable;
    port.fresh = told.usable && told.number != port.number;
    port.quiet = port.fresh ? 0.0 : port.quiet + elapsed;
    if (port.fresh) port.number = told.number;
    const force::OutputLimits& limits = d.limits;
    if (!port.usable || port.quiet > limits.silence) {
        // As the watchdog has it: nothing is left `release` after the last sample.
        const double release = limits.release - way;
        const double most = std::max(0.0, (release - port.quiet - elapsed) / (release - limits.silence));
        port.share = port.usable ? std::min(port.share, most) : 0.0;
    } else {
        port.share = std::min(1.0, port.share + elapsed / limits.ramp_up);
    }
}

// Whether the servo may believe that this device still says where the hand is. One that renders nothing and
// gives no place may rest.
bool speaks(const Description& d, const Port& port) {
    return d.sensing == Sensing::pose || renders(d) ? port.fresh : port.usable;
}

// How fast a pushed tool turns beside its own speed: fingers spin a nut, and what bears torque turns the more
// slowly, as nothing else tells whoever pushes it how hard they pull.
double swiftness(const servo::Setup& setup, const State& s) {
    if (s.output.joint < 0) return 1.0;
    if (s.input.grip == servo::Grip::fingers) return spinning;
    const double greatest = setup.wrench.stiffness * most_wound;
    return 1.0 / (1.0 + firmness * std::abs(s.output.wrench_torque) / greatest);
}

// The hand pushes: the tool goes on from where it is.
void push(const Layout& layout, const servo::Setup& setup, State& s, const device::Sample& sample,
          const Quat& looks, double dt) {
    const Quat turn = looks * layout.workspace.turn;
    Pose& tool = s.workspace.tool;
    tool.position += turn * sample.velocity * dt;
    const Vec3 turned_on = swiftness(setup, s) * (turn * sample.angular_velocity) * dt;
    tool.orientation = glm::normalize(rotation(turned_on) * tool.orientation);
    const Pose& held_back = s.output.tool;
    tool.position = held_back.position + force::at_most(tool.position - held_back.position, ahead);
    const Vec3 turned =
        rotation_vector(glm::normalize(tool.orientation * glm::conjugate(held_back.orientation)));
    if (glm::length(turned) > turned_ahead)
        tool.orientation =
            glm::normalize(rotation(force::at_most(turned, turned_ahead)) * held_back.orientation);
}

void move(const Layout& layout, const servo::Setup& setup, State& s, const Told& told, const Quat& looks,
          bool clutch, double dt) {
    if (layout.mover->sensing == Sensing::rate) {
        if (s.mover.usable && s.mover.quiet < rate_lasts && !clutch)
            push(layout, setup, s, told.sample, looks, dt);
        return;
    }
    if (s.mover.fresh) {
        s.hand = told.sample.pose;
        if (told.opening != s.mover.opening) {
            const Pose tool = s.workspace.tool;
            s.workspace = force::place(layout.workspace, s.hand, tool);
            s.workspace.share = 0.0;
        }
        s.mover.opening = told.opening;
    }
    if (s.mover.number == 0) return;
    const bool away = clutch || !s.mover.usable;
    force::to_assembly(layout.workspace, s.workspace, s.hand, away, dt);
}

// The tool goes there, and follows the hand on from there.
void put(const Layout& layout, State& s, const Pose& tool) {
    const double share = s.workspace.share;
    s.workspace = force::place(layout.workspace, s.hand, tool);
    s.workspace.share = share;
}

// +1: the device's turns are counted as they look from the bolt's end, −1: the other way. Whoever turns a
// wheel looks at it along −z or from above, and onto a nut against the bolt's axis.
double sense(const Description& wheel) {
    return glm::dot(wheel.axis, Vec3(0.0, 1.0, 1.0)) < 0.0 ? -1.0 : 1.0;
}

bool on_bolt(const State& s) { return s.output.joint >= 0; }

void turn(const Layout& layout, const servo::Setup& setup, State& s, const Told& told, bool clutch) {
    if (!s.wheel.fresh) return;
    const double by = told.opening == s.wheel.opening ? told.sample.turn - s.turn : 0.0;
    s.wheel.opening = told.opening;
    s.turn = told.sample.turn;
    if (!on_bolt(s) || clutch || by == 0.0 || !std::isfinite(by)) return;
    const servo::NutPlace& nut = setup.nuts[static_cast<std::size_t>(s.output.joint)];
    const Vec3 centre = servo::nut_centre(nut, s.output.nut_angle);
    const Quat turned = glm::angleAxis(sense(*layout.wheel) * by, nut.axis);
    Pose tool = s.workspace.tool;
    tool.position = centre + turned * (tool.position - centre);
    tool.orientation = glm::normalize(turned * tool.orientation);
    put(layout, s, tool);
}

// Taken, the wrench is where it lay; let go of on a nut it stays there, elsewhere it is put where it lies.
void take_or_leave(const Layout& layout, State& s, servo::Grip grip, const Wishes& wishes) {
    const std::optional<Pose>& rest = wishes.rest;
    if (!rest) return;
    const bool had = s.input.grip == servo::Grip::wrench, has = grip == servo::Grip::wrench;
    if (has && !had && s.lies) {
        put(layout, s, *s.lies);
        s.workspace.share = 0.0;
    }
    if (has) s.lies.reset();
    // The hand stays where it is; what the device moves is its fingertips from now on.
    if (had && !has && layout.wrist && wishes.bare_wrist)
        put(layout, s, s.workspace.tool * *layout.wrist * inverse(*wishes.bare_wrist));
    if (!has && !s.lies) s.lies = had && s.output.joint >= 0 ? s.output.tool : *rest;
}

// What is new of the devices, and what is wished with their buttons too.
Wishes listen(const Layout& layout, State& s, const Heard& heard, double elapsed) {
    Wishes wishes = heard.wishes;
    wishes.held &= heard.age <= wishes.lasts;
    wishes.stop |= std::exchange(s.stopped, false);
    s.pressed = false;
    const auto press = [&](const Port& port, const Told& told, const Buttons& buttons) {
        if (!port.usable) return;
        s.pressed |= (told.sample.buttons & buttons.held) != 0;
        wishes.clutch |= (told.sample.buttons & buttons.clutch) != 0;
        wishes.stop |= (told.sample.buttons & buttons.stop) != 0;
        wishes.reset |= (told.sample.buttons & buttons.reset) != 0;
    };
    if (layout.mover) {
        note(*layout.mover, s.mover, heard.mover, elapsed);
        press(s.mover, heard.mover, layout.mover_buttons);
    }
    if (layout.wheel) {
        note(*layout.wheel, s.wheel, heard.wheel, elapsed);
        press(s.wheel, heard.wheel, layout.wheel_buttons);
    }
    wishes.held |= s.pressed;
    return wishes;
}

servo::Grip grip_of(const Heard& heard) {
    if (!heard.hand) return heard.wishes.grip;
    if (*heard.hand == servo::Grip::wrench) return servo::Grip::wrench;
    return heard.wishes.grip == servo::Grip::fingers ? servo::Grip::fingers : servo::Grip::none;
}

std::uint8_t undo_of(State& s, const Wishes& wishes) {
    if (wishes.marks != s.marks) {
        ++s.marks;
        return servo::keep_mark;
    }
    s.back_wished = wishes.back_number;
    return wishes.back_number != s.back_number ? wishes.back : std::uint8_t{0};
}

force::OutputCommand part(const force::OutputCommand& whole, double share) {
    return {share * whole.force, share * whole.torque};
}

}  // namespace

State initial_state(const Layout& layout) {
    State state;
    state.workspace = force::place(layout.workspace, {}, layout.home);
    state.output.tool = layout.home;
    return state;
}

servo::Input hear(const Layout& layout, const servo::Setup& setup, State& s, const Heard& heard) {
    const double elapsed = setup.dt * (1.0 + static_cast<double>(heard.missed));
    const Wishes wishes = listen(layout, s, heard, elapsed);
    if (layout.mover) move(layout, setup, s, heard.mover, wishes.looks, wishes.clutch, elapsed);
    if (layout.wheel) turn(layout, setup, s, heard.wheel, wishes.clutch);
    if (wishes.put_number != s.put_number) {
        s.put_number = wishes.put_number;
        put(layout, s, wishes.put);
        s.workspace.share = 0.0;
    }
    const servo::Grip grip = grip_of(heard);
    take_or_leave(layout, s, grip, wishes);

    servo::Input input;
    input.device = servo::sample_of(s.workspace.tool);
    input.grip = grip;
    input.undo = undo_of(s, wishes);
    input.setting = wishes.setting;

    input.enabled = wishes.held;
    input.guide = wishes.guide;
    input.stop = wishes.stop;
    input.reset = wishes.reset;
    input.missed = static_cast<std::uint8_t>(std::min<std::uint64_t>(heard.missed, 15));
    // Whichever is felt now.
    const bool by_wheel = layout.wheel && (on_bolt(s) || !layout.mover);
    input.fresh = by_wheel ? speaks(*layout.wheel, s.wheel) : speaks(*layout.mover, s.mover);
    // The devices have let go by themselves. What the output stage still holds must not come back: it is let
    // go of as well, and begins anew.
    s.anew = s.anew || elapsed > hung;
    if (s.anew) input.fresh = false;
    s.input = input;
    return input;
}

void glide(const Layout& layout, const servo::Setup& setup, State& s, const servo::State& servo,
           const Heard& heard, servo::Input& input) {
    if (!layout.mover || layout.mover->sensing != Sensing::rate || renders_force(*layout.mover)) return;
    Pose& tool = s.workspace.tool;
    const int held = s.output.joint;
    const int joint = held < 0 && s.mover.usable && input.enabled ? heard.wishes.glide : -1;
    // A nut that is held takes the tool along as it comes down.
    if (held >= 0) {
        const auto i = static_cast<std::size_t>(held);
        const Vec3 at = servo::nut_centre(setup.nuts[i], servo.joints[i].nut.angle);
        if (s.carried_by == held) tool.position += at - s.carried_at;
        s.carried_at = at;
    }
    s.carried_by = held;
    const servo::ToolPose now = servo::at_pose(s.workspace.tool);
    const auto free = [&](const Vec3& from, const Vec3& to) {
        return !servo.touch || !servo::hidden(*servo.touch, from, to, joint);
    };
    const force::OutputCommand lead = force::guide(gliding, s.glides, servo::guided_tool(setup, now),
                                                   servo::goal_at(setup, servo.joints, joint), free, setup.dt)
                                          .command;
    tool.position += glide_speed * setup.dt * lead.force;
    tool.orientation = glm::normalize(rotation(glide_turn * setup.dt * lead.torque) * tool.orientation);
    input.device = servo::sample_of(tool);
    s.input = input;
}

Answer answer(const Layout& layout, const servo::Setup& setup, State& s, const servo::Output& output) {
    if (output.undone > 0) s.back_number = s.back_wished;
    s.output = output;
    Answer answer;
    if (s.anew) {
        s.anew = output.force != Vec3(0.0) || output.torque != Vec3(0.0);
        s.mover.share = s.wheel.share = 0.0;
    }
    force::OutputCommand felt{output.force, output.torque};
    if (layout.wheel) {
        const bool engaged = on_bolt(s);
        if (engaged) s.axis = setup.nuts[static_cast<std::size_t>(output.joint)].axis;
        s.on_bolt = std::clamp(s.on_bolt + (engaged ? setup.dt : -setup.dt) / wheel_fade, 0.0, 1.0);
        const double torque = glm::dot(felt.torque, s.axis) * s.on_bolt * s.wheel.share;
        answer.wheel.torque = sense(*layout.wheel) * torque * layout.wheel->axis;
        felt.torque = Vec3(0.0);
    }
    if (layout.mover)
        answer.mover = part(force::to_device(layout.workspace, s.workspace, felt), s.mover.share);
    return answer;
}

Answer tick(const Layout& layout, const servo::Setup& setup, State& state, servo::State& servo,
            const Heard& heard) {
    servo::Input input = hear(layout, setup, state, heard);
    glide(layout, setup, state, servo, heard, input);
    return answer(layout, setup, state, servo::tick(setup, servo, input));
}

Pose in_hand(const Layout& layout, const servo::Setup& setup, const State& s, const Wishes& wishes) {
    const bool bare = s.lies && layout.wrist && wishes.bare_wrist;
    if (bare) {
        const Vec3 tip = inverse(*s.lies) * s.workspace.tool.position;
        const Vec3 nearest(std::clamp(tip.x, 0.0, setup.wrench.handle_length), 0.0, 0.0);
        if (glm::distance(tip, nearest) < at_handle) return *s.lies;
    }
    return bare ? s.workspace.tool * *wishes.bare_wrist * inverse(*layout.wrist) : s.workspace.tool;
}

Answer pause(const Layout& layout, const servo::Setup& setup, State& s, const Heard& heard) {
    const double elapsed = setup.dt * (1.0 + static_cast<double>(heard.missed));
    s.stopped = listen(layout, s, heard, elapsed).stop;
    if (layout.mover) move(layout, setup, s, heard.mover, heard.wishes.looks, true, elapsed);
    if (layout.wheel) {
        if (s.wheel.fresh) s.turn = heard.wheel.sample.turn;
        s.wheel.opening = heard.wheel.opening;
    }
    s.anew = true;
    s.on_bolt = s.mover.share = s.wheel.share = 0.0;
    return {};
}

}  // namespace bolt::station
