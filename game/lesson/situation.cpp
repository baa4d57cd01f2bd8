#include "game/lesson/situation.hpp"

#include <cmath>

namespace bolt::lesson {

namespace {

using lesson::StepKind;

constexpr double near = 0.06;                // m from the nut: it is no longer looked for
constexpr double worn = 0.2e-3;              // m off its corners
constexpr double no_room = to_radians(3.0);  // of swing
constexpr double last_part = 0.8;            // of the least torque: from here on it is pulled slowly
constexpr double let_go_share = 0.5;         // of the peak: below it the hand has stopped pulling
constexpr double let_go_clicked = 0.15;      // after a click, which lets the torque fall by itself
constexpr double given = to_radians(2.0);    // turned off: it has broken loose
constexpr double turning = 0.02;             // rad/s
constexpr double fingers_turning = 0.3;      // rad/s
constexpr double wrong_torque = 1.0;         // N·m: more than a wrench's own spring gives back
constexpr double wrong_share = 0.2;          // of the step's torque
constexpr double worked_torque = 0.5;        // N·m

bool out_of_room(const Scene& s) {
    const world::Hand& hand = s.world.only<world::Hand>();
    return hand.doing == world::Doing::holding && hand.room < no_room;
}

Situation without_nut(const Scene& s, const lesson::Step& due, bool fingers) {
    const bool wrench = wrench_in_hand(s);
    if (fingers && wrench) return Situation::put_wrench_away;
    if (!fingers && !wrench) return Situation::take_wrench;
    if (distance_to_due(s) > near) return fingers ? Situation::find_by_fingers : Situation::find_by_wrench;
    if (fingers) return Situation::grip_nut;
    if (world::joint_at(s.world, due.joint).rounded > worn) return Situation::set_on_rounded;
    const bool again = s.lesson.joints[due.joint].peak_torque > worked_torque;
    return again ? Situation::set_on_again : Situation::set_on;
}

Situation running_down(const Scene& s, const world::Joint& joint, bool fingers) {
    if (lesson::reached(s.lesson, s.world)) return Situation::seated;
    const bool by_wrench = held(s) == Held::nut_by_wrench;
    if (by_wrench && fingers) return Situation::put_wrench_away;
    if (!by_wrench && !fingers) return Situation::wrench_needed;
    if (joint.speed < -fingers_turning) return Situation::other_way_on;
    if (out_of_room(s)) return fingers ? Situation::twist_back : Situation::set_back;
    return fingers ? Situation::run_down : Situation::run_down_by_wrench;
}

Situation tightening(const Scene& s, const lesson::Step& due, const world::Joint& joint) {
    if (held(s) == Held::nut_by_fingers) return Situation::wrench_needed;
    const lesson::JointTrack& track = s.lesson.joints[due.joint];
    const content::Window window = lesson::window(s.lesson, due);
    const bool checks = due.kind == StepKind::recheck;
    const bool to_yield = lesson::into_yield(s.lesson, due);
    if (lesson::reached(s.lesson, s.world)) {
        if (checks) return Situation::checked;
        const double still = track.clicked ? let_go_clicked : let_go_share;
        if (joint.torque < still * track.peak_torque) return Situation::take_off;
        if (track.peak_torque > window.high && track.turned_torque > window.high)
            return Situation::stop_too_much;
        if (track.clicked) return Situation::stop_at_click;
        return to_yield && track.yielded ? Situation::stop_at_yield : Situation::stop;
    }
    const bool turns_off = joint.torque < -wrong_torque && joint.speed < -turning;
    if (turns_off || joint.torque < -wrong_torque - wrong_share * due.torque) return Situation::other_way_on;
    if (out_of_room(s)) return Situation::set_back;
    if (checks) return Situation::check;
    if (lesson::setting(s.lesson) > 0.0) return Situation::pull_to_click;
    const bool eases = joint.torque > last_part * window.low;
    if (to_yield) return eases ? Situation::ease_to_yield : Situation::pull_to_yield;
    return eases ? Situation::ease : Situation::pull;
}

Situation loosening(const Scene& s, const lesson::Step& due, const world::Joint& joint) {
    if (lesson::reached(s.lesson, s.world)) return Situation::free;
    if (held(s) == Held::nut_by_fingers) return Situation::wrench_needed;
    const double turned = s.lesson.joints[due.joint].begin_angle - joint.angle;
    if (joint.torque > wrong_torque && joint.speed > turning) return Situation::other_way_off;
    if (joint.torque > wrong_torque + wrong_share * s.lesson.assembly->joints[due.joint].spec.torque.target)
        return Situation::other_way_off;
    if (out_of_room(s)) return Situation::set_back;
    return turned > given ? Situation::turn_off : Situation::break_loose;
}

}  // namespace

bool wrench_in_hand(const Scene& scene) { return scene.world.only<world::Hand>().wrench; }

Held held(const Scene& scene) {
    if (scene.lesson.held >= 0)
        return scene.lesson.grip == servo::Grip::fingers ? Held::nut_by_fingers : Held::nut_by_wrench;
    return wrench_in_hand(scene) ? Held::wrench : Held::nothing;
}

double distance_to_due(const Scene& scene) {
    const lesson::Step* due = scene.lesson.due();
    if (due == nullptr) return std::numeric_limits<double>::infinity();
    const Vec3 nut = world::nut_centre(scene.world, scene.setup, due->joint);
    return glm::distance(scene.world.only<world::Tool>().pose.position, nut);
}

Situation situation(const Scene& scene) {
    const lesson::Step* due = scene.lesson.due();
    if (due == nullptr) return Situation::all_done;
    const servo::NutGeometry& nut = scene.setup.nuts[due->joint];
    const bool fingers = lesson::by_fingers(*scene.lesson.assembly, *due, scene.setup.finger_torque(nut));
    if (scene.lesson.held < 0) return without_nut(scene, *due, fingers);
    if (scene.lesson.held != static_cast<int>(due->joint)) return Situation::wrong_joint;
    const world::Joint& joint = world::joint_at(scene.world, due->joint);
    if (joint.condition == joint::Condition::broken) return Situation::leave_broken;
    if (joint.condition == joint::Condition::stripped) return Situation::leave_stripped;
    switch (due->kind) {
        case StepKind::run_down:
            return running_down(scene, joint, fingers);
        case StepKind::tighten:
        case StepKind::recheck:
            return tightening(scene, *due, joint);
        case StepKind::loosen:
            return loosening(scene, *due, joint);
    }
    return Situation::all_done;
}

}  // namespace bolt::lesson
