#include "game/scene/angle_dial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "game/lesson/step_requirements.hpp"

namespace bolt::scene {

namespace {

// Radii and heights relative to the dial's radius. The window is below the pointer, so that the pointer stays
// visible in front of it.
constexpr double ring_inner = 0.98, ring_outer = 1.02, tick_outer = 1.10, long_tick_outer = 1.18;
constexpr double window_inner = 1.03, window_outer = 1.24, pointer_inner = 0.66, pointer_outer = 1.3;
constexpr double scale_height = 0.02, window_height = 0.012, pointer_height = 0.035;
constexpr double tick_width = to_radians(1.0), mark_width = to_radians(2.5), pointer_width = to_radians(3.0);
constexpr double arc_step = to_radians(3.0);  // largest angle of a facet
// Relative to the nut's width across flats: outside the head of a wrench and above it.
constexpr double dial_radius = 1.35, dial_height = 0.2;
constexpr float dial_outline_opacity = 0.5F;
constexpr glm::vec4 scale_color{0.92F, 0.93F, 0.95F, 1.0F};

// A part of a flat ring: from angle `low` to `high` (rad, clockwise), between two radii, from z = 0 to
// `height`.
struct Sector {
    double low = 0.0, high = 0.0, inner = 0.0, outer = 0.0, height = 0.0;
};

Vec3 on_dial(double angle, double radius, double z) {
    return {radius * std::cos(angle), -radius * std::sin(angle), z};
}

// A flat quadrilateral; a, b, c, d counter-clockwise seen from outside.
void add_face(assets::Primitive& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec3 normal(glm::normalize(glm::cross(b - a, d - a)));
    for (const Vec3& corner : {a, b, c, d}) {
        mesh.positions.emplace_back(corner);
        mesh.normals.push_back(normal);
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + i);
}

void add_sector(assets::Primitive& mesh, const Sector& s) {
    const int facets = std::max(1, static_cast<int>(std::ceil((s.high - s.low) / arc_step)));
    const auto corner = [&](double angle, bool out, bool up) {
        return on_dial(angle, out ? s.outer : s.inner, up ? s.height : 0.0);
    };
    for (int i = 0; i < facets; ++i) {
        const double a = s.low + (s.high - s.low) * i / facets,
                     b = s.low + (s.high - s.low) * (i + 1) / facets;
        add_face(mesh, corner(a, false, true), corner(b, false, true), corner(b, true, true),
                 corner(a, true, true));
        add_face(mesh, corner(a, true, false), corner(b, true, false), corner(b, false, false),
                 corner(a, false, false));
        add_face(mesh, corner(a, true, true), corner(b, true, true), corner(b, true, false),
                 corner(a, true, false));
        add_face(mesh, corner(b, false, true), corner(a, false, true), corner(a, false, false),
                 corner(b, false, false));
    }
    for (const bool last : {false, true}) {
        const double at = last ? s.high : s.low;
        add_face(mesh, corner(at, !last, true), corner(at, !last, false), corner(at, last, false),
                 corner(at, last, true));
    }
}

void add_mesh(assets::Model& model, std::string name, assets::Primitive mesh) {
    mesh.material = 0;
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model.meshes.size());
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
    model.meshes.push_back({std::move(name), {std::move(mesh)}, {}});
}

DialWindow window_of(const content::Assembly& assembly, const lesson::LessonStep& step) {
    const content::ToleranceWindow window = lesson::angle_window(assembly, step);
    const joint::ThreadDirection thread = assembly.joints[step.joint].design.thread_direction;
    if (thread == joint::ThreadDirection::left) return {-window.high, -window.low};
    return {window.low, window.high};
}

}  // namespace

std::vector<DialWindow> dial_windows(const content::Assembly& assembly) {
    std::vector<DialWindow> windows;
    for (const lesson::LessonStep& step : lesson::make_plan(assembly, lesson::Task::tighten)) {
        if (step.kind != lesson::StepKind::turn) continue;
        const DialWindow window = window_of(assembly, step);
        if (std::find(windows.begin(), windows.end(), window) == windows.end()) windows.push_back(window);
    }
    return windows;
}

assets::Model dial_model(const std::vector<DialWindow>& windows) {
    assets::Model model;
    if (windows.empty()) return model;
    assets::Material material;
    material.name = "dial";
    material.metallic = 0.0F;
    material.roughness = 0.7F;
    model.materials.push_back(material);
    assets::Primitive scale;
    add_sector(scale, {0.0, 2.0 * pi, ring_inner, ring_outer, scale_height});
    for (int degrees = 0; degrees < 360; degrees += 10) {
        const double at = to_radians(degrees), half = 0.5 * (degrees == 0 ? mark_width : tick_width);
        add_sector(scale, {at - half, at + half, degrees == 0 ? pointer_inner : ring_outer,
                           degrees % 30 == 0 ? long_tick_outer : tick_outer, scale_height});
    }
    add_mesh(model, "scale", std::move(scale));
    assets::Primitive pointer;
    add_sector(pointer,
               {-0.5 * pointer_width, 0.5 * pointer_width, pointer_inner, pointer_outer, pointer_height});
    add_mesh(model, "pointer", std::move(pointer));
    for (std::size_t i = 0; i < windows.size(); ++i) {
        assets::Primitive window;
        add_sector(window, {windows[i].low, windows[i].high, window_inner, window_outer, window_height});
        add_mesh(model, fmt::format("window {}", i), std::move(window));
    }
    return model;
}

std::optional<Dial> dial_of(const lesson::Lesson& lesson, const servo::Setup& setup,
                            const ecs::Access<const world::Joint>& joints, const view::Palette& palette) {
    const lesson::LessonStep* due = lesson.due();
    if (due == nullptr || due->kind != lesson::StepKind::turn || !lesson.joints[due->joint].mark)
        return std::nullopt;
    const servo::NutGeometry& nut = setup.nuts[due->joint];
    const double radius = dial_radius * nut.across_flats;
    const Vec3 at = world::nut_centre(joints, setup, due->joint) +
                    (0.5 * nut.height + dial_height * nut.across_flats) * nut.axis;
    Dial dial;
    dial.world = {glm::dvec4(radius * nut.e1, 0.0), glm::dvec4(radius * nut.e2, 0.0),
                  glm::dvec4(radius * nut.axis, 0.0), glm::dvec4(at, 1.0)};
    const double turned = lesson::angle_from_mark(lesson, joints, due->joint);
    dial.angle = nut.sense * turned;
    const content::ToleranceWindow window = lesson::angle_window(*lesson.assembly, *due);
    dial.window = window_of(*lesson.assembly, *due);
    dial.shows_window = lesson.mode != lesson::Mode::assessment;
    dial.window_color = palette.ok;
    dial.pointer_color = palette.due;
    if (dial.shows_window && turned >= window.low) dial.pointer_color = scale_color;
    if (dial.shows_window && turned > window.high) dial.pointer_color = palette.high;
    return dial;
}

void show_dial(SceneWorld& world, const std::optional<Dial>& dial) {
    world.view<DialMarker, Transform>().each(
        [&](ecs::Entity entity, DialMarker& marker, Transform& transform) {
            const bool window = marker.shape == DialShape::window;
            marker.shown = dial && (!window || (dial->shows_window && marker.window == dial->window));
            if (!marker.shown) {
                world.remove<Outline>(entity);
                return;
            }
            const bool pointer = marker.shape == DialShape::pointer;
            const glm::dmat4 turned =
                pointer ? glm::rotate(dial->world, -dial->angle, Vec3(0, 0, 1)) : dial->world;
            transform.world = glm::mat4(turned);
            marker.color = pointer ? dial->pointer_color : window ? dial->window_color : scale_color;
            if (marker.shape != DialShape::scale)
                world.add<Outline>(entity, glm::vec4(glm::vec3(marker.color), dial_outline_opacity));
        });
}

}  // namespace bolt::scene
