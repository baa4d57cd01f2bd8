#include "game/scene/annotations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "game/lesson/feedback.hpp"
#include "game/lesson/step_requirements.hpp"

namespace bolt::scene {

namespace {

constexpr int segments = 20, along_arc = 18, along_head = 6;
constexpr float outline_opacity = 0.55F;

// Dimensions relative to the arrow's scale; `head` is a fraction of its length.
struct ArrowProfile {
    double head = 0.0, shaft_radius = 0.0, head_radius = 0.0, length = 1.0;
    std::function<Pose(double)> spine;  // at 0 … 1 along the arrow; its z is the direction of the arrow
};

// A ring of vertices. `lean`: component of the normal along the arrow, −1 … 1; 0: radial.
struct ArrowRing {
    double at = 0.0, radius = 0.0, lean = 0.0;
};

void add_ring(assets::Primitive& mesh, const ArrowProfile& profile, const ArrowRing& ring, bool joined) {
    const Pose pose = profile.spine(ring.at);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double outward = std::sqrt(1.0 - ring.lean * ring.lean);
    for (int i = 0; i <= segments; ++i) {
        const double phi = 2.0 * pi * i / segments;
        const Vec3 out(std::cos(phi), std::sin(phi), 0.0);
        mesh.positions.emplace_back(pose * (ring.radius * out));
        mesh.normals.emplace_back(pose.orientation * (outward * out + ring.lean * Vec3(0, 0, 1)));
    }
    if (!joined) return;
    constexpr std::uint32_t row = segments + 1;
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t a = first - row + i, b = first + i;
        for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) mesh.indices.push_back(index);
    }
}

// The rear face, the shaft, the shoulder and the head; they share no vertices, because their normals differ.
assets::Primitive arrow_mesh(const ArrowProfile& profile) {
    assets::Primitive mesh;
    const double neck = 1.0 - profile.head;
    add_ring(mesh, profile, {0.0, 0.0, -1.0}, false);
    add_ring(mesh, profile, {0.0, profile.shaft_radius, -1.0}, true);
    for (int i = 0; i <= along_arc; ++i)
        add_ring(mesh, profile, {neck * i / along_arc, profile.shaft_radius, 0.0}, i > 0);
    add_ring(mesh, profile, {neck, profile.shaft_radius, -1.0}, false);
    add_ring(mesh, profile, {neck, profile.head_radius, -1.0}, true);
    const double slope = profile.head_radius / std::hypot(profile.head_radius, profile.head * profile.length);
    for (int i = 0; i <= along_head; ++i) {
        const double share = static_cast<double>(i) / along_head;
        add_ring(mesh, profile, {neck + profile.head * share, profile.head_radius * (1.0 - share), slope},
                 i > 0);
    }
    mesh.material = 0;
    return mesh;
}

Pose on_line(double share) { return {Vec3(0.0, 0.0, share), Quat(1.0, 0.0, 0.0, 0.0)}; }

Pose on_arc(double share) {
    const double angle = share * arrow_sweep;
    const Quat turned = glm::angleAxis(angle, Vec3(0, 0, 1));
    return {turned * Vec3(1, 0, 0), turned * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
}

void add_mesh(assets::Model& model, const char* name, assets::Primitive mesh) {
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model.meshes.size());
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
    model.meshes.push_back({name, {std::move(mesh)}, {}});
}

glm::dmat4 matrix(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& at, double scale) {
    return {glm::dvec4(scale * x, 0.0), glm::dvec4(scale * y, 0.0), glm::dvec4(scale * z, 0.0),
            glm::dvec4(at, 1.0)};
}

}  // namespace

assets::Model arrow_model() {
    assets::Model model;
    assets::Material material;
    material.name = "arrow";
    material.metallic = 0.0F;
    material.roughness = 0.6F;
    model.materials.push_back(material);
    add_mesh(model, "straight", arrow_mesh({0.4, 0.055, 0.17, 1.0, on_line}));
    add_mesh(model, "round", arrow_mesh({0.3, 0.05, 0.15, arrow_sweep, on_arc}));
    return model;
}

MotionArrow straight_arrow(const Vec3& from, const Vec3& to, const glm::vec4& color) {
    const double length = glm::distance(from, to);
    const Vec3 z = (to - from) / length;
    const Vec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), z));
    return {ArrowShape::straight, matrix(x, glm::cross(z, x), z, from, length), color};
}

MotionArrow round_arrow(const ArrowArc& arc, const glm::vec4& color) {
    const Vec3 x = glm::normalize(arc.from - arc.axis * glm::dot(arc.axis, arc.from));
    return {ArrowShape::round, matrix(x, glm::cross(arc.axis, x), arc.axis, arc.middle, arc.radius), color};
}

std::optional<MotionArrow> force_arrow(const Vec3& at, const Vec3& force) {
    constexpr double slenderness = 0.4;
    constexpr glm::vec4 color{0.78F, 0.45F, 1.0F, 1.0F};  // violet, unlike motions and verdicts
    if (glm::length(force) < min_arrow_force) return std::nullopt;
    MotionArrow arrow = straight_arrow(at, at + force_arrow_length * force, color);
    arrow.world = glm::scale(arrow.world, Vec3(slenderness, slenderness, 1.0));
    return arrow;
}

void show_arrow(SceneWorld& world, const std::optional<MotionArrow>& arrow, ArrowMeaning meaning) {
    world.view<ArrowMarker, Transform>().each(
        [&](ecs::Entity entity, ArrowMarker& marker, Transform& transform) {
            if (marker.meaning != meaning) return;
            marker.shown = arrow && arrow->shape == marker.shape;
            if (!marker.shown) {
                world.remove<Outline>(entity);
                return;
            }
            transform.world = glm::mat4(arrow->world);
            marker.color = arrow->color;
            world.add<Outline>(entity, glm::vec4(glm::vec3(arrow->color), outline_opacity));
        });
}

namespace {

constexpr glm::vec4 plate_color{0.06F, 0.07F, 0.08F, 0.82F};

// Adds the symbol and colour of the verdict on a torque or an angle; none below the window. `turned`: the
// highest torque at which the nut turned, or the angle. The verdict is "high" only if `turned` exceeds the
// window too, because a high breakaway torque does not overtighten the joint.
void add_verdict(render::Label& label, const content::ToleranceWindow& window, double torque, double turned,
                 const view::Palette& palette) {
    if (torque < window.low) return;
    const bool too_much = torque > window.high && turned > window.high;
    label.color = too_much ? palette.high_text : palette.ok_text;
    label.text = fmt::format("{} {}", view::symbol_of(too_much ? lesson::Verdict::high : lesson::Verdict::ok),
                             label.text);
}

// The nut angle from which the displayed angle counts, rad; none if the joint has no mark and is not due.
std::optional<double> angle_origin(const lesson::Lesson& lesson, std::size_t joint) {
    const lesson::JointTrack& track = lesson.joints[joint];
    if (track.mark) return *track.mark;
    const lesson::LessonStep* due = lesson.due();
    return due != nullptr && due->joint == joint ? std::optional(track.begin_angle) : std::nullopt;
}

std::string work_text(const words::Words& words, const lesson::Lesson& lesson, const world::Joint& joint,
                      bool wrench) {
    if (!wrench)
        return words::format_text(words, "hud.turns",
                                  {{"turns", words::Number{joint.angle / (2.0 * pi), 1}}});
    std::string text = words::format_number(words, words::Number{std::abs(joint.torque), 0}) + " N·m   ";
    const auto from = angle_origin(lesson, joint.index);
    const lesson::LessonStep* due = lesson.due();
    const bool turns = due != nullptr && due->joint == joint.index && due->kind == lesson::StepKind::turn;
    if (from) text += fmt::format("{:+.0f}°", to_degrees(joint.angle - *from));
    if (from && turns) text += fmt::format(" / {:.0f}°", to_degrees(due->angle));
    if (from) text += "   ";
    return text + words[lesson::text_key(joint.stage)];
}

}  // namespace

render::Label plate_label(std::string text, const Vec3& position, float height) {
    render::Label label;
    label.text = std::move(text);
    label.position = glm::vec3(position);
    label.height = height;
    label.anchor = {0.5F, 0.0F};
    label.plate = plate_color;
    label.color = label_color;
    label.occluded_visibility = 1.0F;
    return label;
}

Vec3 label_position(const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                    std::size_t joint) {
    return world::nut_centre(joints, setup, joint) + 0.03 * setup.nuts[joint].axis;
}

std::optional<render::Label> work_label(const words::Words& words, const lesson::Lesson& lesson,
                                        const servo::Setup& setup, const WorkAccess& world,
                                        const view::Palette& palette) {
    const std::int16_t engaged = world.only<world::ToolState>().joint;
    if (engaged < 0) return std::nullopt;
    const auto joint = static_cast<std::size_t>(engaged);
    const world::Joint& now = world::joint_at(world, joint);
    const bool wrench = world.only<world::WorkingHand>().wrench;
    const lesson::LessonStep* due = lesson.due();
    const double torque = std::abs(now.torque);
    const bool is_due = due != nullptr && due->joint == joint && due->kind == lesson::StepKind::tighten;
    render::Label label =
        plate_label(work_text(words, lesson, now, wrench), label_position(setup, world, joint), 22.0F);
    const bool turns = due != nullptr && due->joint == joint && due->kind == lesson::StepKind::turn;
    const double turned = lesson::angle_from_mark(lesson, world, joint);
    if (wrench && lesson.mode != lesson::Mode::assessment && turns)
        add_verdict(label, lesson::angle_window(*lesson.assembly, *due), turned, turned, palette);
    else if (wrench && lesson.mode != lesson::Mode::assessment)
        add_verdict(label,
                    is_due ? lesson::torque_window(lesson, *due) : lesson.assembly->joints[joint].spec.torque,
                    torque, lesson.joints[joint].turned_torque, palette);
    label.offset_px = {0.0F, 34.0F};
    return label;
}

std::optional<render::Label> pull_label(
    const words::Words& words, const servo::Setup& setup,
    const ecs::Access<const world::Joint, const world::ToolState, const world::WorkingHand,
                      const world::ConstrainedTool>& world) {
    constexpr double above = 0.07;  // m, over the back of the hand
    const std::int16_t engaged = world.only<world::ToolState>().joint;
    if (engaged < 0 || !world.only<world::WorkingHand>().wrench) return std::nullopt;
    const double torque = world::joint_at(world, static_cast<std::size_t>(engaged)).torque;
    const double force = std::abs(torque) / setup.wrench.handle_length;
    const Vec3 hand = world.only<world::ConstrainedTool>().pose * Vec3(setup.wrench.handle_length, 0.0, 0.0);
    return plate_label(words::format_text(words, "label.pull", {{"force", words::Number{force, 0}}}),
                       hand + Vec3(0.0, above, 0.0), 18.0F);
}

render::Label clamp_label(const words::Words& words, const content::Assembly& assembly,
                          const servo::Setup& setup, const ecs::Access<const world::Joint>& joints,
                          std::size_t joint) {
    const double clamp = world::joint_at(joints, joint).clamp;
    const std::string force = words::format_number(words, words::Number{clamp / 1e3, 1});
    render::Label label = plate_label(fmt::format("{} {} kN", assembly.joints[joint].design.id, force),
                                      label_position(setup, joints, joint), 15.0F);
    label.offset_px = {0.0F, 8.0F};
    return label;
}

}  // namespace bolt::scene
