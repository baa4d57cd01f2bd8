#include "game/sound/event_detection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/servo/tool_contact.hpp"

namespace bolt::sound {

std::vector<StruckSurface> struck_surfaces(const content::Assembly& assembly,
                                           std::span<const session::ObstacleName> names) {
    std::vector<StruckSurface> surfaces;
    for (const session::ObstacleName& name : names) {
        if (!name.id.is_fixed()) continue;
        const std::size_t index = name.id.index();
        surfaces.resize(std::max(surfaces.size(), index + 1), StruckSurface::casing);
        const bool fastener = std::any_of(assembly.joints.begin(), assembly.joints.end(), [&](const auto& j) {
            return name.name.rfind(j.design.id + "_", 0) == 0;
        });
        if (fastener) surfaces[index] = StruckSurface::nut;
    }
    return surfaces;
}

namespace {

// s over which a strike must reduce the wrench's speed. A wrench that is held back for one tick and then
// moves on did not strike.
constexpr double strike_window = 4e-3;
constexpr double min_strike = 0.03;  // m/s; smaller changes of speed come from the hand itself
// A wrench that trembles against an obstacle must not strike in every tick: a further strike must be louder
// by masking_ratio than what remains of the last one after a decay with masking_time (s).
constexpr double masking_time = 0.05;
constexpr double masking_ratio = 1.5;

constexpr double seated_load = 0.1;            // of full load; at this load the nut only creeps
constexpr double default_contact_force = 3.0;  // N, for a station without a force device

EventDetector::WrenchEnds ends_of(const servo::Setup& setup, const Pose& tool) {
    return {tool.position, tool.position + tool.orientation * Vec3(setup.wrench.handle_length, 0.0, 0.0)};
}

// Clamp force over the joint's reference load. The published law has no clamp force: torque over its maximum.
double load_of(const servo::Setup& setup, const world::Joint& joint) {
    if (setup.group.law == joint::Law::published)
        return std::abs(joint.torque) / setup.group.published[joint.index].parameters.T_max_Nm;
    const double reference = setup.group.joints[joint.index].reference_load;
    return reference > 0.0 ? joint.clamp / reference : 0.0;
}

const world::Joint* engaged_joint(const Audible& world) {
    const std::int16_t joint = world.only<world::ToolState>().joint;
    return joint < 0 ? nullptr : &world::joint_at(world, static_cast<std::size_t>(joint));
}

std::size_t window_ticks(const servo::Setup& setup) {
    const auto ticks = static_cast<std::size_t>(std::lround(strike_window / setup.dt));
    return std::clamp<std::size_t>(ticks, 2, EventDetector::max_history / 2);
}

// Returns the speed, m/s, that one end lost in the last n ticks, along its direction in the n ticks before.
double lost_speed(const EventDetector& detector, Vec3 EventDetector::WrenchEnds::*end, std::size_t n,
                  double dt) {
    const Vec3 before =
        (detector.history[n].*end - detector.history[2 * n].*end) / (static_cast<double>(n) * dt);
    const double speed = glm::length(before);
    if (speed == 0.0) return 0.0;
    double remaining = -speed;
    for (std::size_t i = 0; i < n; ++i)
        remaining =
            std::max(remaining, glm::dot(detector.history[i].*end - detector.history[i + 1].*end, before) /
                                    (speed * dt));
    return speed - remaining;
}

void add_to_history(EventDetector& detector, const servo::Setup& setup,
                    const EventDetector::WrenchEnds& now) {
    // A tool that is picked up jumps to the hand; that is not a motion.
    if (detector.history_size > 0 &&
        glm::length(now.jaw - detector.history[0].jaw) > setup.limits.speed * setup.dt)
        detector.history_size = 0;
    std::copy_backward(detector.history.begin(), detector.history.end() - 1, detector.history.end());
    detector.history[0] = now;
    detector.history_size = std::min(detector.history_size + 1, detector.history.size());
}

void detect_strike(EventDetector& detector, const servo::Setup& setup, const world::ToolState& contact,
                   SoundCues& cues) {
    const std::size_t n = window_ticks(setup);
    detector.since_strike += setup.dt;
    if (detector.history_size <= 2 * n || detector.ticks_since_contact > n) return;
    double strike = lost_speed(detector, &EventDetector::WrenchEnds::jaw, n, setup.dt);
    // When the hand stops a wrench that turns a nut, its handle stops without a strike.
    const bool turns_nut = contact.joint >= 0 && detector.last_surface == StruckSurface::nut;
    if (!turns_nut)
        strike = std::max(strike, lost_speed(detector, &EventDetector::WrenchEnds::handle, n, setup.dt));
    // A wrench may stop over several ticks; the strike is the highest loss of speed.
    const double masked =
        masking_ratio * detector.last_strike * std::exp(-detector.since_strike / masking_time);
    if (strike > detector.pending_strike && strike > std::max(min_strike, masked)) {
        detector.pending_strike = strike;
        return;
    }
    if (detector.pending_strike == 0.0) return;
    cues.strike_speed = static_cast<float>(detector.pending_strike);
    detector.last_strike = std::exchange(detector.pending_strike, 0.0);
    detector.since_strike = 0.0;
}

void detect_slide(const EventDetector& detector, const servo::Setup& setup, const world::ToolState& contact,
                  const Vec3& force, SoundCues& cues) {
    // The jaw does not slide on the nut that it turns.
    const bool turned_nut =
        contact.joint >= 0 &&
        contact.obstacle == collision::ObstacleId::nut(static_cast<std::size_t>(contact.joint));
    if (turned_nut || detector.history_size < 2) return;
    const Vec3 slide = 0.5 *
                       (detector.history[0].jaw - detector.history[1].jaw + detector.history[0].handle -
                        detector.history[1].handle) /
                       setup.dt;
    const double speed = glm::length(slide);
    const Vec3 direction = speed > 0.0 ? slide / speed : Vec3(0.0);
    const double normal_force = glm::length(force - glm::dot(force, direction) * direction);
    cues.slide_speed = static_cast<float>(speed);
    cues.contact_force = static_cast<float>(setup.limits.force > 0.0 ? normal_force : default_contact_force);
}

StruckSurface surface_of(const EventDetector& detector, collision::ObstacleId touched) {
    if (touched.is_nut()) return StruckSurface::nut;
    return touched.index() < detector.surfaces.size() ? detector.surfaces[touched.index()]
                                                      : StruckSurface::casing;
}

void detect_contact(EventDetector& detector, const servo::Setup& setup, const Audible& world,
                    SoundCues& cues) {
    const world::ToolState& contact = world.only<world::ToolState>();
    add_to_history(detector, setup, ends_of(setup, world.only<world::ConstrainedTool>().pose));
    if (!contact.obstacle.is_none()) {
        detector.ticks_since_contact = 0;
        detector.last_surface = surface_of(detector, contact.obstacle);
        detect_slide(detector, setup, contact, world.only<world::DeviceForce>().force, cues);
    } else {
        ++detector.ticks_since_contact;
    }
    cues.surface = detector.last_surface;
    detect_strike(detector, setup, contact, cues);
}

void detect_nut(EventDetector& detector, const servo::Setup& setup, const Audible& world, SoundCues& cues) {
    const world::ToolState& contact = world.only<world::ToolState>();
    const world::Joint* engaged = engaged_joint(world);
    const double load = engaged != nullptr ? load_of(setup, *engaged) : 0.0;
    if (engaged != nullptr && contact.joint == detector.joint) {
        double turned = std::abs(engaged->angle - detector.nut_angle) / setup.dt;
        if (turned > setup.limits.angular_speed) turned = 0.0;  // a jump, by undoing a step
        const double loaded_share = std::clamp(load / seated_load, 0.0, 1.0);
        cues.run_speed = static_cast<float>((1.0 - loaded_share) * turned);
        cues.creep_speed = static_cast<float>(loaded_share * turned);
        cues.load = static_cast<float>(load);
    }
    // A jaw that slipped no longer engages the joint, so the joint's load is that of the last tick.
    if (contact.slipped >= 0) cues.slip = static_cast<float>(std::max(0.05, detector.load));
    detector.joint = contact.joint;
    if (engaged != nullptr) detector.nut_angle = engaged->angle;
    detector.load = load;
}

// The slack of a ratchet rises while the handle swings back, and drops by one tooth when the pawl falls into
// the next one. In a tick no hand turns a handle forward by half a tooth, which would lower the slack too.
void detect_tooth(EventDetector& detector, const servo::Setup& setup, const world::ToolState& contact,
                  SoundCues& cues) {
    const double drop = detector.ratchet_slack - contact.ratchet_slack;
    const bool same_joint = contact.joint >= 0 && contact.joint == detector.joint;
    const double tooth = setup.wrench.ratchet.tooth_angle;
    cues.tooth = same_joint && tooth > 0.0 && drop > 0.5 * tooth;
    detector.ratchet_slack = contact.ratchet_slack;
}

}  // namespace

SoundCues detect_events(EventDetector& detector, const servo::Setup& setup, const Audible& world,
                        const LessonCues& lesson) {
    SoundCues cues;
    detect_contact(detector, setup, world, cues);
    detect_tooth(detector, setup, world.only<world::ToolState>(), cues);
    detect_nut(detector, setup, world, cues);
    cues.click = world.only<world::ToolState>().clicked;
    cues.done = lesson.done;
    cues.mistake = lesson.mistake;
    return cues;
}

LessonCues lesson_cues(std::span<const lesson::LessonEvent> events) {
    LessonCues cues;
    for (const lesson::LessonEvent& event : events) {
        cues.done = cues.done || event.kind == lesson::EventKind::step_end;
        cues.mistake = cues.mistake || event.kind == lesson::EventKind::mistake;
    }
    return cues;
}

}  // namespace bolt::sound
