#include "haptics/station/step.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::station {

namespace {

using device::Description;
using device::Sensing;
using device::Told;

constexpr double hung = 0.010;       // s without a tick, less than device::KeeperOptions::stale
constexpr double wheel_fade = 0.05;  // s in which a wheel comes onto a bolt and off it

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

// The hand pushes: the tool goes on from where it is.
void push(const Layout& layout, State& s, const device::Sample& sample, double dt) {
    const Quat& turn = layout.workspace.turn;
    Pose& tool = s.workspace.tool;
    tool.position += turn * sample.velocity * dt;
    tool.orientation = glm::normalize(rotation(turn * sample.angular_velocity * dt) * tool.orientation);
    const Pose& held_back = s.output.tool;
    tool.position = held_back.position + force::at_most(tool.position - held_back.position, ahead);
    const Vec3 turned =
        rotation_vector(glm::normalize(tool.orientation * glm::conjugate(held_back.orientation)));
    if (glm::length(turned) > turned_ahead)
        tool.orientation =
            glm::normalize(rotation(force::at_most(turned, turned_ahead)) * held_back.orientation);
}

void move(const Layout& layout, State& s, const Told& told, bool clutch, double dt) {
    if (layout.mover->sensing == Sensing::rate) {
        if (s.mover.usable && s.mover.quiet < rate_lasts && !clutch) push(layout, s, told.sample, dt);
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

// +1: the device's turns are counted as they look from the bolt's end, −1: the other way. Whoever turns a
// wheel looks at it along −z or from above, and onto a nut against the bolt's axis.
double sense(const Description& wheel) {
    return glm::dot(wheel.axis, Vec3(0.0, 1.0, 1.0)) < 0.0 ? -1.0 : 1.0;
}

bool on_bolt(const State& s) { return s.output.joint >= 0 && s.input.grip == servo::Grip::wrench; }

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
    const double share = s.workspace.share;
    s.workspace = force::place(layout.workspace, s.hand, tool);
    s.workspace.share = share;
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
    Wishes wishes = heard.wishes;
    const auto press = [&](const Port& port, const Told& told, const Buttons& buttons) {
        if (!port.usable) return;
        wishes.held |= (told.sample.buttons & buttons.held) != 0;
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
    if (layout.mover) move(layout, s, heard.mover, wishes.clutch, elapsed);
    if (layout.wheel) turn(layout, setup, s, heard.wheel, wishes.clutch);

    servo::Input input;
    input.device = servo::sample_of(s.workspace.tool);
    input.grip = heard.hand.value_or(wishes.grip);
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

Answer answer(const Layout& layout, const servo::Setup& setup, State& s, const servo::Output& output) {
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
    const servo::Input input = hear(layout, setup, state, heard);
    return answer(layout, setup, state, servo::tick(setup, servo, input));
}

}  // namespace bolt::station
