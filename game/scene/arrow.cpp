#include "game/scene/arrow.hpp"

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

namespace bolt::scene {

namespace {

constexpr int around = 20, along_arc = 18, along_head = 6;
constexpr float line_opacity = 0.55F;

// What of an arrow's length is its head, and how thick shaft and head are.
struct Shape {
    double head = 0.0, shaft_radius = 0.0, head_radius = 0.0, length = 1.0;
    std::function<Pose(double)> spine;  // 0 … 1: a point, its z on along the arrow
};

// A ring of vertices; `lean`: of the normal, 0 outward, ±1 along the arrow.
struct Ring {
    double at = 0.0, radius = 0.0, lean = 0.0;
};

void add_ring(assets::Primitive& mesh, const Shape& shape, const Ring& ring, bool joined) {
    const Pose place = shape.spine(ring.at);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double outward = std::sqrt(1.0 - ring.lean * ring.lean);
    for (int i = 0; i <= around; ++i) {
        const double phi = 2.0 * pi * i / around;
        const Vec3 out(std::cos(phi), std::sin(phi), 0.0);
        mesh.positions.emplace_back(place * (ring.radius * out));
        mesh.normals.emplace_back(place.orientation * (outward * out + ring.lean * Vec3(0, 0, 1)));
    }
    if (!joined) return;
    constexpr std::uint32_t row = around + 1;
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t a = first - row + i, b = first + i;
        for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) mesh.indices.push_back(index);
    }
}

// Its end, the shaft, the shoulder and the head; each with normals of its own.
assets::Primitive arrow_mesh(const Shape& shape) {
    assets::Primitive mesh;
    const double neck = 1.0 - shape.head;
    add_ring(mesh, shape, {0.0, 0.0, -1.0}, false);
    add_ring(mesh, shape, {0.0, shape.shaft_radius, -1.0}, true);
    for (int i = 0; i <= along_arc; ++i)
        add_ring(mesh, shape, {neck * i / along_arc, shape.shaft_radius, 0.0}, i > 0);
    add_ring(mesh, shape, {neck, shape.shaft_radius, -1.0}, false);
    add_ring(mesh, shape, {neck, shape.head_radius, -1.0}, true);
    const double slope = shape.head_radius / std::hypot(shape.head_radius, shape.head * shape.length);
    for (int i = 0; i <= along_head; ++i) {
        const double share = static_cast<double>(i) / along_head;
        add_ring(mesh, shape, {neck + shape.head * share, shape.head_radius * (1.0 - share), slope}, i > 0);
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

Arrow straight_arrow(const Vec3& from, const Vec3& to, const glm::vec4& color) {
    const double length = glm::distance(from, to);
    const Vec3 z = (to - from) / length;
    const Vec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), z));
    return {ArrowShape::straight, matrix(x, glm::cross(z, x), z, from, length), color};
}

Arrow round_arrow(const Turn& turn, const glm::vec4& color) {
    const Vec3 x = glm::normalize(turn.from - turn.axis * glm::dot(turn.axis, turn.from));
    return {ArrowShape::round, matrix(x, glm::cross(turn.axis, x), turn.axis, turn.middle, turn.radius),
            color};
}

void show_arrow(World& world, const std::optional<Arrow>& arrow) {
    world.view<Pointer, Placement>().each([&](ecs::Entity entity, Pointer& pointer, Placement& placement) {
        pointer.shown = arrow && arrow->shape == pointer.shape;
        if (!pointer.shown) {
            world.remove<Outlined>(entity);
            return;
        }
        placement.world = glm::mat4(arrow->world);
        pointer.color = arrow->color;
        world.add<Outlined>(entity, glm::vec4(glm::vec3(arrow->color), line_opacity));
    });
}

}  // namespace bolt::scene
