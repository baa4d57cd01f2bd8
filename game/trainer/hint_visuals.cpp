#include "game/trainer/hint_visuals.hpp"

#include <algorithm>
#include <cmath>

#include "game/motion/path_planning.hpp"
#include "game/scene/annotations.hpp"
#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

namespace {

using lesson::HintMotion;
using scene::MotionArrow;

// Heights of a straight arrow above its target, relative to the nut's width.
constexpr double tip_height = 1.6, tail_height = 4.4;
// Radii, relative to the length of the handle and the width of the nut.
constexpr double handle_radius = 0.45, finger_radius = 1.15;
constexpr double handle_stroke = to_radians(40.0), finger_stroke = to_radians(60.0);  // of animated ghosts
constexpr double handle_height = 0.03, finger_height = 0.02, return_height = 0.06;    // m

MotionArrow down_to(const Vec3& at, const Vec3& up, double width, const glm::vec4& color) {
    return scene::straight_arrow(at + tail_height * width * up, at + tip_height * width * up, color);
}

MotionArrow up_from(const Vec3& at, const Vec3& up, double width) {
    return scene::straight_arrow(at + tip_height * width * up, at + tail_height * width * up, backward_color);
}

// `sense`: 1 tightens.
MotionArrow handle_arrow(const MotionGeometry& geometry, double sense, double height,
                         const glm::vec4& color) {
    const Vec3 axis = -sense * servo::loosening_axis(geometry.nut);
    return scene::round_arrow(
        {geometry.nut_centre + height * geometry.nut.axis, axis, geometry.tool.orientation * Vec3(1, 0, 0),
         handle_radius * geometry.handle_length},
        color);
}

MotionArrow finger_arrow(const MotionGeometry& geometry, double sense, const glm::vec4& color) {
    return scene::round_arrow({geometry.nut_centre + finger_height * geometry.nut.axis,
                               -sense * servo::loosening_axis(geometry.nut), geometry.nut.e1,
                               finger_radius * geometry.nut.across_flats},
                              color);
}

// A ghost at its target.
struct Ghost {
    Pose pose;
    const hand::Skeleton* posture = nullptr;
    bool has_wrench = false;
};

// The hand where it should work: fingers on the nut, or around the wrench at rest.
Ghost hand_ghost(const ActiveLesson& active, HintMotion motion, const MotionGeometry& geometry) {
    const scene::Postures& postures = postures_of(active);
    if (motion == HintMotion::take) {
        const std::size_t posture =
            scene::natural_handle_posture(postures, geometry.rest, Vec3(0, 1, 0), active.shoulder);
        return {geometry.rest, &postures.on_handle.at(posture)};
    }
    const Pose at{geometry.nut_centre, motion::tool_orientation(geometry.nut, 0.0, false)};
    return {scene::frame_towards(at, active.shoulder, 0.0),
            motion == HintMotion::let_go ? &postures.open : &postures.on_nut};
}

// The pose in which the hand would put the wrench on the nut. Cached per step, because the search casts rays.
const Pose& wrench_ghost_pose(ActiveLesson& active, const lesson::LessonStep& due) {
    const std::size_t step = active.session->lesson().current;
    if (!active.guidance.wrench_ghost || active.guidance.wrench_ghost->first != step)
        active.guidance.wrench_ghost = {
            step, wrench_pose_on_nut(hand_of(active).rest, active.session->setup(), active.session->state(),
                                     due.joint, due.kind == lesson::StepKind::loosen)};
    return active.guidance.wrench_ghost->second;
}

bool begins_on_nut(HintMotion motion) {
    return motion == HintMotion::pull_on || motion == HintMotion::pull_off ||
           motion == HintMotion::set_back || motion == HintMotion::lift;
}

// The hand on the wrench, and the wrench: at rest, or on the nut.
Ghost wrench_ghost(ActiveLesson& active, const lesson::Hint& hint, const lesson::LessonStep& due,
                   const MotionGeometry& geometry) {
    const bool at_tool = hint.level >= 3 && begins_on_nut(hint.motion);
    const Pose& tool = hint.motion == HintMotion::put_away ? geometry.rest
                       : at_tool                           ? geometry.tool
                                                           : wrench_ghost_pose(active, due);
    const scene::Postures& postures = postures_of(active);
    const std::size_t posture = scene::natural_handle_posture(postures, tool, Vec3(0, 1, 0), active.shoulder);
    return {tool, &postures.on_handle.at(posture), true};
}

void show_ghosts(scene::SceneWorld& world, ActiveLesson& active, const lesson::Hint& hint,
                 const lesson::LessonStep& due, const MotionGeometry& geometry) {
    if (hint.ghost() == lesson::GhostKind::none) return;
    const Ghost ghost = hint.ghost() == lesson::GhostKind::hand ? hand_ghost(active, hint.motion, geometry)
                                                                : wrench_ghost(active, hint, due, geometry);
    const double share = ghost_share(active.session->time());
    const Pose pose = hint.level >= 3 ? animated_ghost(hint.motion, ghost.pose, geometry, share) : ghost.pose;
    if (ghost.has_wrench) scene::show_wrench_ghost(world, active.session->setup().tool, pose);
    scene::show_hand_ghost(world, pose, *ghost.posture);
}

MotionGeometry geometry_of(const ActiveLesson& active, const lesson::LessonStep& due, std::size_t joint) {
    const servo::Setup& setup = active.session->setup();
    const servo::NutGeometry& nut = setup.nuts[joint];
    return {nut,
            world::nut_centre(active.workplace.world, setup, joint),
            tool_of(active).pose,
            hand_of(active).rest,
            setup.wrench.handle_length,
            due.kind == lesson::StepKind::loosen};
}

}  // namespace

std::optional<MotionArrow> arrow_of(HintMotion motion, const MotionGeometry& geometry) {
    const Vec3& axis = geometry.nut.axis;
    const Vec3 grip = geometry.rest * Vec3(0.5 * geometry.handle_length, 0.0, 0.0);
    const double sense = geometry.loosens ? -1.0 : 1.0, width = geometry.nut.across_flats;
    switch (motion) {
        case HintMotion::none:
            return std::nullopt;
        case HintMotion::counter_hold:
            return down_to(geometry.nut.seat - geometry.nut.held_distance * axis, -axis, width,
                           forward_color);
        case HintMotion::take:
            return down_to(grip, geometry.rest.orientation * Vec3(0, 0, 1), width, forward_color);
        case HintMotion::put_away:
            return down_to(grip, geometry.rest.orientation * Vec3(0, 0, 1), width, backward_color);
        case HintMotion::approach:
        case HintMotion::reach:
        case HintMotion::set_on:
        case HintMotion::grip_nut:
            return down_to(geometry.nut_centre, axis, width, forward_color);
        case HintMotion::spin:
            return finger_arrow(geometry, 1.0, forward_color);
        case HintMotion::twist_back:
            return finger_arrow(geometry, -1.0, backward_color);
        case HintMotion::pull_on:
            return handle_arrow(geometry, 1.0, handle_height, forward_color);
        case HintMotion::pull_off:
            return handle_arrow(geometry, -1.0, handle_height, forward_color);
        case HintMotion::set_back:
            return handle_arrow(geometry, -sense, return_height, backward_color);
        case HintMotion::let_go:
        case HintMotion::lift:
            return up_from(geometry.nut_centre, axis, width);
    }
    return std::nullopt;
}

double ghost_share(double time) {
    return minimum_jerk(
        std::min(1.0, std::fmod(time, ghost_motion_time + ghost_rest_time) / ghost_motion_time));
}

Pose animated_ghost(HintMotion motion, const Pose& target, const MotionGeometry& geometry, double share) {
    const Vec3 of_rest = geometry.rest.orientation * Vec3(0, 0, 1);
    const double distance = (tail_height - tip_height) * geometry.nut.across_flats;
    const double sense = geometry.loosens ? -1.0 : 1.0;
    const auto moved = [&](const Vec3& by) { return Pose{target.position + by, target.orientation}; };
    // `turn`: rad, tightening positive.
    const auto turned = [&](double turn) {
        const Quat about = rotation(-turn * servo::loosening_axis(geometry.nut));
        return Pose{geometry.nut_centre + about * (target.position - geometry.nut_centre),
                    glm::normalize(about * target.orientation)};
    };
    switch (motion) {
        case HintMotion::none:
        case HintMotion::counter_hold:
            return target;
        case HintMotion::take:
        case HintMotion::put_away:
            return moved((1.0 - share) * distance * of_rest);
        case HintMotion::approach:
        case HintMotion::reach:
        case HintMotion::set_on:
        case HintMotion::grip_nut:
            return moved((1.0 - share) * distance * geometry.nut.axis);
        case HintMotion::let_go:
        case HintMotion::lift:
            return moved(share * distance * geometry.nut.axis);
        case HintMotion::spin:
            return turned(share * finger_stroke);
        case HintMotion::twist_back:
            return turned(-share * finger_stroke);
        case HintMotion::pull_on:
            return turned(share * handle_stroke);
        case HintMotion::pull_off:
            return turned(-share * handle_stroke);
        case HintMotion::set_back:
            return turned(-sense * share * handle_stroke);
    }
    return target;
}

void show_hint_visuals(scene::SceneWorld& world, ActiveLesson& active, const lesson::Hint* hint) {
    scene::hide_ghosts(world);
    const lesson::LessonStep* due = active.session->lesson().due();
    if (hint == nullptr || due == nullptr) {
        active.guidance.wrench_ghost.reset();
        scene::show_arrow(world, std::nullopt);
        return;
    }
    // A held nut is released where it is, even if another joint is due.
    const int held = active.session->lesson().held_joint;
    const std::size_t joint = held >= 0 ? static_cast<std::size_t>(held) : due->joint;
    const MotionGeometry geometry = geometry_of(active, *due, joint);
    scene::show_arrow(world, arrow_of(hint->arrow(), geometry));
    show_ghosts(world, active, *hint, *due, geometry);
}

}  // namespace bolt::trainer
