#include "tools/author/pictures/swing_fan.hpp"

#include <cmath>

namespace bolt::author {

namespace {

constexpr double facet = to_radians(2.0);
constexpr double rim_share = 0.025;  // width of the rim, as a fraction of the outer radius

void add_sector(assets::Primitive& primitive, double from, double to, double inner, double outer,
                double height) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / facet)));
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (int i = 0; i <= steps; ++i) {
        const double angle = from + (to - from) * i / steps;
        for (const double radius : {inner, outer}) {
            primitive.positions.emplace_back(fan_point(angle, radius, height));
            primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
    }
    for (int i = 0; i < steps; ++i) {
        const std::uint32_t a = first + 2U * static_cast<std::uint32_t>(i), b = a + 1, c = a + 2, d = a + 3;
        primitive.indices.insert(primitive.indices.end(), {a, b, d, a, d, c, a, d, b, a, c, d});
    }
}

}  // namespace

Vec3 fan_point(double angle, double radius, double height) {
    return {radius * std::cos(angle), height, -radius * std::sin(angle)};
}

assets::Model make_swing_fan(const geometry::FreeSwing& swing, const FanRing& ring) {
    assets::Model fan;
    std::vector<assets::Primitive> primitives(fan_meshes);
    const auto add = [&](FanMesh mesh, double from, double to, double inner, double outer) {
        add_sector(primitives[static_cast<std::size_t>(mesh)], from, to, inner, outer, ring.height);
    };
    const double rim = (1.0 - rim_share) * ring.outer;
    for (const geometry::Arc& arc : swing.arcs) {
        add(FanMesh::free, arc.from, arc.to, ring.inner, rim);
        add(FanMesh::free_rim, arc.from, arc.to, rim, ring.outer);
    }
    for (const geometry::BlockedArc& arc : swing.blocked) {
        add(FanMesh::blocked, arc.from, arc.to, ring.inner, rim);
        add(FanMesh::blocked_rim, arc.from, arc.to, rim, ring.outer);
    }
    for (std::size_t i = 0; i < fan_meshes; ++i) {
        assets::Node node;
        node.mesh = static_cast<int>(i);
        fan.roots.push_back(static_cast<int>(i));
        fan.nodes.push_back(std::move(node));
        fan.meshes.emplace_back().primitives.push_back(std::move(primitives[i]));
    }
    return fan;
}

}  // namespace bolt::author
