#include "tools/verify/arms/feel_runs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "game/motion/path_planning.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/collision/narrow_phase.hpp"

namespace bolt::arm_validation {

namespace {

constexpr double before_contact = 0.005;  // m
constexpr double push = 0.5;              // N, on an arm that no hand holds
constexpr double approach_speed = 0.15;   // m/s of the wrench
constexpr double shake_begin = 0.9, shake_end = 1.4, shake_rate = 2.0 * pi * 6.0;           // s, s, rad/s
constexpr double early_begin = 1.5, early_end = 1.8, late_begin = 2.4, run_duration = 2.7;  // s
constexpr std::size_t pulled_joint = 0;
constexpr int max_tries = 500;

// The greatest swing of points within windows of 40 ms, less the straight motion between the window's ends: a
// hand that drifts does not tremble.
class SwingMeter {
  public:
    void add(const std::array<Vec3, 2>& points) {
        window_[count_++] = points;
        if (count_ < window_.size()) return;
        const auto last = static_cast<double>(count_ - 1);
        for (std::size_t p = 0; p < points.size(); ++p) {
            Vec3 low(1e9), high(-1e9);
            for (std::size_t i = 0; i < count_; ++i) {
                const Vec3 straight =
                    glm::mix(window_.front()[p], window_.back()[p], static_cast<double>(i) / last);
                low = glm::min(low, window_[i][p] - straight);
                high = glm::max(high, window_[i][p] - straight);
            }
            const Vec3 width = high - low;
            swing = std::max({swing, width.x, width.y, width.z});
        }
        count_ = 0;
    }
    double swing = 0.0;  // m

  private:
    std::array<std::array<Vec3, 2>, 40> window_{};
    std::size_t count_ = 0;
};

class Measurement {
  public:
    explicit Measurement(const ArmRig& rig)
        // The end of a lever shows rotations. Without torque output only the hand causes them: no lever.
        : lever_(station::renders_torque(*rig.layout.mover) ? 0.1 : 0.0) {}

    void note(const ArmRig& rig, bool felt) {
        const Pose& hand = rig.arm.pose;
        const std::array points{hand.position, hand * Vec3(lever_, 0.0, 0.0)};
        if (rig.time >= early_begin && rig.time < early_end) early_.add(points);
        if (rig.time >= late_begin) late_.add(points);
        outcome_.touched = outcome_.touched || felt;
    }
    FeelOutcome finish(const ArmRig& rig) {
        outcome_.record = rig.record;
        outcome_.held = !rig.unheld;
        outcome_.early_swing = early_.swing;
        outcome_.late_swing = late_.swing;
        return outcome_;
    }

  private:
    double lever_;  // m
    SwingMeter early_, late_;
    FeelOutcome outcome_;
};

// Share of the device's greatest force with which a hand presses; a softer hand presses less.
double press_share(const NamedHandImpedance& hand) {
    return std::clamp(0.2 + hand.stiffness / 2000.0, 0.2, 0.6);
}

double shake_at(double time) {
    return time > shake_begin && time < shake_end ? std::sin(shake_rate * (time - shake_begin)) : 0.0;
}

// m that the wrench can move along `direction` until it touches; nullopt if it starts near an obstacle or
// touches nothing.
std::optional<double> free_way(servo::ToolContact& contact, const Pose& start, const Vec3& direction) {
    constexpr double band = 5e-3, clear = 0.02, farthest = 0.6;
    std::array<collision::Contact, proxy::max_contacts> found;
    double way = 0.0;
    while (way < farthest) {
        const Pose pose{start.position + way * direction, start.orientation};
        const collision::ContactQueryResult result =
            collision::find_contacts(contact.world, contact.wrench, pose, band, contact.narrow_phase, found);
        double nearest = result.complete_within;
        for (const collision::Contact& c : std::span(found).first(result.count))
            nearest = std::min(nearest, c.distance);
        if (nearest < 2.0 * contact.parameters.skin) return way > clear ? std::optional(way) : std::nullopt;
        way += std::max(0.8 * nearest, 1e-4);
    }
    return std::nullopt;
}

struct Aim {
    Pose pose;
    Vec3 direction{0.0};
};

// A random start: a level wrench above the casing or, for "side", beside it; and the direction to the casing.
Aim aim_at(const collision::BoundingBox& casing, std::string_view name, Random& random) {
    const Vec3 up(0.0, 1.0, 0.0), middle = 0.5 * (casing.low + casing.high);
    const Quat level = glm::angleAxis(-0.5 * pi, Vec3(1.0, 0.0, 0.0));  // the wrench's normal points up
    const double heading = random.uniform(0.0, 2.0 * pi);
    Aim aim{{middle, glm::angleAxis(heading, up) * level}, -up};
    aim.pose.position.x = random.uniform(casing.low.x, casing.high.x);
    aim.pose.position.y = casing.high.y + 0.1;
    const Vec3 handle = aim.pose.orientation * Vec3(1.0, 0.0, 0.0);
    if (name == "corner")
        aim.pose.orientation = rotation(0.35 * glm::cross(handle, up) + 0.2 * handle) * aim.pose.orientation;
    if (name == "edge" || name == "near a bolt") aim.pose.position -= 0.1 * handle;
    if (name == "side") {
        aim.direction = Vec3(0.0, 0.0, random.chance(0.5) ? 1.0 : -1.0);
        aim.pose.position.y = glm::mix(middle.y, casing.high.y, random.uniform(0.2, 0.8));
        aim.pose.position.z = middle.z - (0.5 * (casing.high.z - casing.low.z) + 0.3) * aim.direction.z;
    }
    return aim;
}

// Returns true if the jaw is so near to a bolt that the wrench turns to the bolt by itself, away from where
// the hand presses (haptics/station/near_nut.cpp).
bool near_a_bolt(const servo::Setup& setup, const Vec3& jaw) {
    constexpr double aside = 0.13, above = 0.11;  // m
    return std::any_of(setup.nuts.begin(), setup.nuts.end(), [&](const servo::NutGeometry& nut) {
        const Vec3 from = jaw - nut.seat;
        const double height = glm::dot(from, nut.axis);
        return height < above && glm::length(from - height * nut.axis) < aside;
    });
}

}  // namespace

bool gives_energy(const FeelOutcome& o) { return o.record.energy > (o.held ? 0.0 : max_energy_of_free_arm); }

bool trembles(const FeelOutcome& o) {
    return o.late_swing > perceptible_swing && o.late_swing > 0.3 * o.early_swing;
}

bool is_stable(const FeelOutcome& o) {
    return !gives_energy(o) && o.record.greatest_energy <= max_energy && !trembles(o);
}

double step_percent(const FeelOutcome& o, const device::Description& arm) {
    const double force = o.record.step / arm.limits.force;
    const double torque = arm.limits.torque > 0.0 ? o.record.torque_step / arm.limits.torque : 0.0;
    return 100.0 * std::max(force, torque);
}

FeelOutcome worse(const FeelOutcome& a, const FeelOutcome& b) {
    FeelOutcome w = trembles(b) || (!trembles(a) && b.late_swing > a.late_swing) ? b : a;
    const auto most = [&](double Record::*value) {
        w.record.*value = std::max(a.record.*value, b.record.*value);
    };
    for (double Record::*value : {&Record::energy, &Record::greatest_energy, &Record::greatest_force,
                                  &Record::greatest_torque, &Record::step, &Record::torque_step})
        most(value);
    w.touched = a.touched && b.touched;
    w.held = a.held && b.held;
    return w;
}

std::vector<Press> find_presses(TightenedAssembly& tightened, std::uint64_t seed) {
    const servo::Setup setup = session::make_setup(tightened.assembly, tightened.assembly.law, {}, 1, 1e-3);
    std::vector<Press> presses;
    Random random(seed, 41);
    const collision::BoundingBox& casing = tightened.state.tool_contact->world.shapes.front().solid.box;
    for (const std::string_view name : {"face", "corner", "edge", "side", "near a bolt"})
        for (int tried = 0; tried < max_tries; ++tried) {
            const Aim aim = aim_at(casing, name, random);
            const auto way = free_way(*tightened.state.tool_contact, aim.pose, aim.direction);
            if (!way ||
                near_a_bolt(setup, aim.pose.position + *way * aim.direction) != (name == "near a bolt"))
                continue;
            const Vec3 start = aim.pose.position + (*way - before_contact) * aim.direction;
            presses.push_back({name, {start, aim.pose.orientation}, aim.direction, before_contact});
            break;
        }
    return presses;
}

FeelOutcome run_press(TightenedAssembly& tightened, RigOptions options, const Press& press) {
    options.tool = press.start;
    ArmRig rig(tightened, options);
    const double stiffness = rig.arm.parameters.stiffness;
    const double strength =
        rig.unheld ? push : press_share(options.hand) * rig.layout.mover->limits.force;  // N
    const Vec3 direction =
        rig.device_pose({press.start.position + press.direction, press.start.orientation}).position;
    const Vec3 along = glm::normalize(direction - rig.arm.pose.position);
    const double to_contact = press.distance / rig.layout.workspace.scale;
    const double end = to_contact + strength / stiffness;
    const Pose begin = rig.arm.pose;
    const Vec3 shaking(0.005, 0.002, 0.003);  // m
    Measurement measurement(rig);
    while (rig.time < run_duration) {
        const double way = rig.unheld ? end : approach_speed / rig.layout.workspace.scale * rig.time;
        rig.arm.intention = begin;
        rig.arm.intention.position += std::min(way, end) * along;
        if (!rig.unheld) rig.arm.intention.position += shake_at(rig.time) * shaking;
        rig.tick();
        measurement.note(rig, rig.contact_force() > 0.05);
    }
    return measurement.finish(rig);
}

namespace {

// The pose of the wrench on the nut, `above` m higher than its middle.
Pose wrench_on_nut(TightenedAssembly& tightened, double above) {
    const servo::Setup setup = session::make_setup(tightened.assembly, tightened.assembly.law, {}, 1, 1e-3);
    const servo::NutGeometry& nut = setup.nuts[pulled_joint];
    const double angle = tightened.state.joints[pulled_joint].nut.angle;
    const motion::HandleAngle handle =
        motion::choose_handle_angle(setup, &*tightened.state.tool_contact, pulled_joint,
                                    tightened.state.joints[pulled_joint], angle, 1.0, to_radians(60.0));
    return {servo::nut_centre(nut, angle) + above * nut.axis,
            motion::tool_orientation(nut, handle.angle, handle.flipped)};
}

// rad by which the hand's intention must lead the wrench so that the hand's spring pulls with this share of
// the device's greatest force or torque.
double lead_for(const ArmRig& rig, double share) {
    const device::HandAndArmParameters& hand = rig.arm.parameters;
    const force::OutputLimits& limits = rig.layout.mover->limits;
    if (limits.torque > 0.0)
        return std::min((rig.unheld ? 0.1 : share) * limits.torque / hand.angular_stiffness, 1.2);
    const double strength = rig.unheld ? push : share * limits.force;
    const double lever_arm = station::lever_arm_of(rig.layout, rig.setup.wrench.handle_length);
    return std::min(strength / hand.stiffness * rig.layout.workspace.scale / lever_arm, 1.2);
}

// rad, the intended angle of the handle at a time.
double intended_angle(const ArmRig& rig, Pull pull) {
    const double t = rig.time;
    if (pull != Pull::hold) return std::min(1.2 * t, lead_for(rig, 1.0) + (pull == Pull::yield ? 0.9 : 0.4));
    const double lead = lead_for(rig, 0.4) + 2.0 * rig.setup.wrench.half_play;
    if (rig.unheld) return lead;
    return lead * (std::min(t / 0.5, 1.0) + 0.5 * shake_at(t));
}

}  // namespace

FeelOutcome run_pull(TightenedAssembly& tightened, RigOptions options, Pull pull) {
    options.tool = wrench_on_nut(tightened, pull == Pull::slip_off ? 0.0095 : 0.0);
    ArmRig rig(tightened, options);
    const servo::NutGeometry& nut = rig.setup.nuts[pulled_joint];
    Measurement measurement(rig);
    while (rig.time < run_duration) {
        // Tightening turns about −axis.
        const Quat turn = glm::angleAxis(-intended_angle(rig, pull), nut.axis);
        const Vec3 centre = servo::nut_centre(nut, rig.servo.joints[pulled_joint].nut.angle);
        const Pose turned{centre + turn * (options.tool.position - centre), turn * options.tool.orientation};
        rig.arm.intention = rig.device_pose(turned);
        rig.tick();
        measurement.note(rig, std::abs(rig.output().wrench_torque) > 1.0);
    }
    return measurement.finish(rig);
}

}  // namespace bolt::arm_validation
