#include "game/trainer/hint_visuals.hpp"

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
constexpr double handle_height = 0.03, finger_height = 0.02, return_height = 0.06;  // m

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

// Shows the hand where it should work: fingers on the nut, or around the wrench at rest.
void show_hand(scene::SceneWorld& world, ActiveLesson& active, HintMotion motion) {
    const servo::Setup& setup = active.session->setup();
    const lesson::LessonStep* due = active.session->lesson().due();
    if (motion == HintMotion::take) {
        const std::size_t posture = scene::natural_handle_posture(postures_of(active), hand_of(active).rest,
                                                                  Vec3(0, 1, 0), active.shoulder);
        scene::show_hand_ghost(world, hand_of(active).rest, postures_of(active).on_handle.at(posture));
        return;
    }
    const servo::NutGeometry& nut = setup.nuts[due->joint];
    const Pose at{world::nut_centre(active.workplace.world, setup, due->joint),
                  motion::tool_orientation(nut, 0.0, false)};
    scene::show_hand_ghost(
        world, scene::frame_towards(at, active.shoulder, 0.0),
        motion == HintMotion::let_go ? postures_of(active).open : postures_of(active).on_nut);
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

void show_ghosts(scene::SceneWorld& world, ActiveLesson& active, const lesson::Hint& hint,
                 const lesson::LessonStep& due) {
    if (hint.ghost() == lesson::GhostKind::none) return;
    if (hint.ghost() == lesson::GhostKind::hand) {
        show_hand(world, active, hint.motion);
        return;
    }
    const Pose& tool = wrench_ghost_pose(active, due);
    const std::size_t posture =
        scene::natural_handle_posture(postures_of(active), tool, Vec3(0, 1, 0), active.shoulder);
    scene::show_wrench_ghost(world, active.session->setup().tool, tool);
    scene::show_hand_ghost(world, tool, postures_of(active).on_handle.at(posture));
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
    scene::show_arrow(world, arrow_of(hint->arrow(), geometry_of(active, *due, joint)));
    show_ghosts(world, active, *hint, *due);
}

}  // namespace bolt::trainer
