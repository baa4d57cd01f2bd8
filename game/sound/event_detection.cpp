#include "game/sound/event_detection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/servo/tool_contact.hpp"

namespace bolt::sound {

std::vector<Met> materials(const content::Assembly& assembly, std::span<const session::ObstacleName> names) {
    std::vector<Met> all;
    for (const session::ObstacleName& name : names) {
        if (!name.id.is_fixed()) continue;
        const std::size_t at = name.id.index();
        all.resize(std::max(all.size(), at + 1), Met::casing);
        const bool fastener = std::any_of(assembly.joints.begin(), assembly.joints.end(), [&](const auto& j) {
            return name.name.rfind(j.design.id + "_", 0) == 0;
        });
        if (fastener) all[at] = Met::nut;
    }
    return all;
}

namespace {

// s, in which a wrench that struck something must have lost its speed for good: one that is held back for a
// tick and then goes on did not.
constexpr double struck_within = 4e-3;
constexpr double least_strike = 0.03;  // m/s; what is slower, hands do themselves
// A wrench that trembles against something does not knock in every tick: what follows must be louder than
// what rings on.
constexpr double rings_on = 0.05;  // s
constexpr double louder = 1.5;

constexpr double seated = 0.1;       // of full load: from here the thread is under load and does not run
constexpr double usual_press = 3.0;  // N, where there is no device whose force would tell

Ear::Ends ends_of(const servo::Setup& setup, const Pose& tool) {
    return {tool.position, tool.position + tool.orientation * Vec3(setup.wrench.handle_length, 0.0, 0.0)};
}

// Clamp force over what the joint is worth; the published law has torques only.
double load_of(const servo::Setup& setup, const world::Joint& joint) {
    if (setup.group.law == joint::Law::published)
        return std::abs(joint.torque) / setup.group.published.T_max_Nm;
    const double reference = setup.group.joints[joint.index].reference_load;
    return reference > 0.0 ? joint.clamp / reference : 0.0;
}

const world::Joint* engaged_joint(const Audible& world) {
    const std::int16_t joint = world.only<world::ToolContact>().joint;
    return joint < 0 ? nullptr : &world::joint_at(world, static_cast<std::size_t>(joint));
}

std::size_t window(const servo::Setup& setup) {
    const auto ticks = static_cast<std::size_t>(std::lround(struck_within / setup.dt));
    return std::clamp<std::size_t>(ticks, 2, Ear::most_back / 2);
}

// m/s that one end lost, along the way that it went before: what goes faster is not hit.
double lost(const Ear& ear, Vec3 Ear::Ends::*end, std::size_t n, double dt) {
    const Vec3 before = (ear.was[n].*end - ear.was[2 * n].*end) / (static_cast<double>(n) * dt);
    const double fast = glm::length(before);
    if (fast == 0.0) return 0.0;
    double left = -fast;
    for (std::size_t i = 0; i < n; ++i)
        left = std::max(left, glm::dot(ear.was[i].*end - ear.was[i + 1].*end, before) / (fast * dt));
    return fast - left;
}

void remember(Ear& ear, const servo::Setup& setup, const Ear::Ends& now) {
    // A tool that is taken into the hand is suddenly elsewhere: that is no motion.
    if (ear.known > 0 && glm::length(now.jaw - ear.was[0].jaw) > setup.limits.speed * setup.dt) ear.known = 0;
    std::copy_backward(ear.was.begin(), ear.was.end() - 1, ear.was.end());
    ear.was[0] = now;
    ear.known = std::min(ear.known + 1, ear.was.size());
}

void hear_strike(Ear& ear, const servo::Setup& setup, const world::ToolContact& contact, Heard& heard) {
    const std::size_t n = window(setup);
    ear.since_strike += setup.dt;
    if (ear.known <= 2 * n || ear.untouched > n) return;
    double hard = lost(ear, &Ear::Ends::jaw, n, setup.dt);
    // A wrench that turns a nut stops turning when the hand does: nothing is struck by that.
    const bool turns = contact.joint >= 0 && ear.met == Met::nut;
    if (!turns) hard = std::max(hard, lost(ear, &Ear::Ends::grip, n, setup.dt));
    // Where it comes to rest over some ticks, the most is what it lost.
    const double masked = louder * ear.last_strike * std::exp(-ear.since_strike / rings_on);
    if (hard > ear.rising && hard > std::max(least_strike, masked)) {
        ear.rising = hard;
        return;
    }
    if (ear.rising == 0.0) return;
    heard.strike = static_cast<float>(ear.rising);
    ear.last_strike = std::exchange(ear.rising, 0.0);
    ear.since_strike = 0.0;
}

void hear_slide(const Ear& ear, const servo::Setup& setup, const world::ToolContact& contact,
                const Vec3& force, Heard& heard) {
    // With a nut that it turns the jaw goes along.
    const bool own = contact.joint >= 0 &&
                     contact.obstacle == collision::ObstacleId::nut(static_cast<std::size_t>(contact.joint));
    if (own || ear.known < 2) return;
    const Vec3 slide = 0.5 * (ear.was[0].jaw - ear.was[1].jaw + ear.was[0].grip - ear.was[1].grip) / setup.dt;
    const double fast = glm::length(slide);
    const Vec3 along = fast > 0.0 ? slide / fast : Vec3(0.0);
    const double pressed = glm::length(force - glm::dot(force, along) * along);
    heard.slide = static_cast<float>(fast);
    heard.press = static_cast<float>(setup.limits.force > 0.0 ? pressed : usual_press);
}

Met met_of(const Ear& ear, collision::ObstacleId touched) {
    if (touched.is_nut()) return Met::nut;
    return touched.index() < ear.still.size() ? ear.still[touched.index()] : Met::casing;
}

void hear_contact(Ear& ear, const servo::Setup& setup, const Audible& world, Heard& heard) {
    const world::ToolContact& contact = world.only<world::ToolContact>();
    remember(ear, setup, ends_of(setup, world.only<world::Tool>().pose));
    if (!contact.obstacle.is_none()) {
        ear.untouched = 0;
        ear.met = met_of(ear, contact.obstacle);
        hear_slide(ear, setup, contact, world.only<world::DeviceForce>().force, heard);
    } else {
        ++ear.untouched;
    }
    heard.met = ear.met;
    hear_strike(ear, setup, contact, heard);
}

void hear_nut(Ear& ear, const servo::Setup& setup, const Audible& world, Heard& heard) {
    const world::ToolContact& contact = world.only<world::ToolContact>();
    const world::Joint* engaged = engaged_joint(world);
    const double load = engaged != nullptr ? load_of(setup, *engaged) : 0.0;
    if (engaged != nullptr && contact.joint == ear.joint) {
        double turned = std::abs(engaged->angle - ear.nut_angle) / setup.dt;
        if (turned > setup.limits.angular_speed) turned = 0.0;  // an undone step, no motion either
        const double under = std::clamp(load / seated, 0.0, 1.0);
        heard.run = static_cast<float>((1.0 - under) * turned);
        heard.creep = static_cast<float>(under * turned);
        heard.load = static_cast<float>(load);
    }
    // The joint that slips is engaged no more: how much it bore is known from the tick before.
    if (contact.slipped >= 0) heard.slip = static_cast<float>(std::max(0.05, ear.load));
    ear.joint = contact.joint;
    if (engaged != nullptr) ear.nut_angle = engaged->angle;
    ear.load = load;
}

}  // namespace

Heard hear(Ear& ear, const servo::Setup& setup, const Audible& world, const Cues& cues) {
    Heard heard;
    hear_contact(ear, setup, world, heard);
    hear_nut(ear, setup, world, heard);
    heard.click = world.only<world::ToolContact>().clicked;
    heard.done = cues.done;
    heard.mistake = cues.mistake;
    return heard;
}

Cues cues_of(std::span<const lesson::Event> events) {
    Cues cues;
    for (const lesson::Event& event : events) {
        cues.done = cues.done || event.kind == "step_end";
        cues.mistake = cues.mistake || event.kind == "mistake";
    }
    return cues;
}

}  // namespace bolt::sound
