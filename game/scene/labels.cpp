#include "game/scene/labels.hpp"

#include <fmt/format.h>

#include <cmath>

#include "game/lesson/terms.hpp"

namespace bolt::scene {

namespace {

constexpr glm::vec4 plate_color{0.06F, 0.07F, 0.08F, 0.82F};

// How a torque lies to what is asked for now, by a sign and by colour; what is still below it is only a
// number. Breakaway turns nothing (`turned`: with what the nut was turned), and is not too much.
void show_standing(render::Label& label, const content::Window& window, double torque, double turned,
                   const view::Palette& palette) {
    if (torque < window.low) return;
    const bool too_much = torque > window.high && turned > window.high;
    label.color = too_much ? palette.wrong : palette.right;
    label.text = fmt::format("{} {}", view::sign_of(too_much ? lesson::Verdict::high : lesson::Verdict::ok),
                             label.text);
}

// Since when a nut's angle counts: out of its turn, and not snug, it says nothing.
std::optional<double> counted_from(const lesson::Lesson& lesson, std::size_t joint) {
    const lesson::JointTrack& track = lesson.joints[joint];
    if (track.snug) return track.snug_angle;
    const lesson::Step* due = lesson.due();
    return due != nullptr && due->joint == joint ? std::optional(track.begin_angle) : std::nullopt;
}

std::string figures(const words::Words& words, const lesson::Lesson& lesson, const world::Joint& joint,
                    bool wrench) {
    if (!wrench)
        return words::say(words, "hud.turns", {{"turns", words::Number{joint.angle / (2.0 * pi), 1}}});
    std::string said = words::say(words, words::Number{std::abs(joint.torque), 0}) + " N·m   ";
    const auto from = counted_from(lesson, joint.index);
    if (from) said += fmt::format("{:+.0f}°   ", to_degrees(joint.angle - *from));
    return said + words[lesson::term(joint.stage)];
}

}  // namespace

render::Label plate(std::string text, const Vec3& at, float height) {
    render::Label label;
    label.text = std::move(text);
    label.position = glm::vec3(at);
    label.height = height;
    label.anchor = {0.5F, 0.0F};
    label.plate = plate_color;
    label.color = label_color;
    label.through = 1.0F;
    return label;
}

Vec3 above_nut(const servo::Setup& setup, const ecs::Access<const world::Joint>& joints, std::size_t joint) {
    return world::nut_centre(joints, setup, joint) + 0.03 * setup.nuts[joint].axis;
}

std::optional<render::Label> work_label(const words::Words& words, const lesson::Lesson& lesson,
                                        const servo::Setup& setup, const WorkAccess& world,
                                        const view::Palette& palette) {
    const std::int16_t engaged = world.only<world::ToolContact>().joint;
    if (engaged < 0) return std::nullopt;
    const auto joint = static_cast<std::size_t>(engaged);
    const world::Joint& now = world::joint_at(world, joint);
    const bool wrench = world.only<world::Hand>().wrench;
    const lesson::Step* due = lesson.due();
    const double torque = std::abs(now.torque);
    const bool fits = due != nullptr && due->joint == joint && due->kind == lesson::StepKind::tighten;
    render::Label label = plate(figures(words, lesson, now, wrench), above_nut(setup, world, joint), 22.0F);
    if (wrench && lesson.mode != lesson::Mode::assessment)
        show_standing(label, fits ? lesson::window(lesson, *due) : lesson.assembly->joints[joint].spec.torque,
                      torque, lesson.joints[joint].turned_torque, palette);
    label.moved_px = {0.0F, 34.0F};
    return label;
}

render::Label clamp_label(const words::Words& words, const content::Assembly& assembly,
                          const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                          std::size_t joint) {
    const double clamp = world::joint_at(joints, joint).clamp;
    const std::string force = words::say(words, words::Number{clamp / 1e3, 1});
    render::Label label = plate(fmt::format("{} {} kN", assembly.joints[joint].design.id, force),
                                above_nut(setup, joints, joint), 15.0F);
    label.moved_px = {0.0F, 8.0F};
    return label;
}

}  // namespace bolt::scene
