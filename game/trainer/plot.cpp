#include "game/trainer/plot.hpp"

#include <cmath>

namespace bolt::trainer {

namespace {

constexpr std::size_t most_points = 4000;
constexpr float seen_angle = 0.02F, seen_torque = 0.2F;  // less than a pixel

std::optional<content::Window> aim_of(const lesson::Lesson& lesson, std::size_t joint) {
    if (lesson.task != lesson::Task::tighten) return std::nullopt;
    const lesson::Step* due = lesson.due();
    const bool its_turn = due != nullptr && due->joint == joint && due->kind != lesson::StepKind::run_down;
    return its_turn ? lesson::window(lesson, *due) : lesson.assembly->joints[joint].spec.torque;
}

}  // namespace

void note(Plot& plot, const lesson::Lesson& lesson,
          const ecs::Access<const world::Joint, const world::ToolContact>& world) {
    const std::int16_t engaged = world.only<world::ToolContact>().joint;
    if (engaged < 0) return;
    if (engaged != plot.joint) plot.points.clear();
    plot.joint = engaged;
    plot.aim = aim_of(lesson, static_cast<std::size_t>(plot.joint));
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(plot.joint));
    const PlotPoint now{static_cast<float>(to_degrees(joint.angle)), static_cast<float>(joint.torque)};
    const bool same = !plot.points.empty() && std::abs(plot.points.back().angle - now.angle) < seen_angle &&
                      std::abs(plot.points.back().torque - now.torque) < seen_torque;
    if (!same && plot.points.size() < most_points) plot.points.push_back(now);
}

}  // namespace bolt::trainer
