#include "tools/assets/sculpt/solid.hpp"

#include <algorithm>
#include <cmath>

#include "tools/assets/sculpt/mesh.hpp"
#include "tools/assets/sculpt/quantise.hpp"

namespace bolt::sculpt {
namespace {

int dominant_axis(const Vec3& n) {
    const Vec3 a = glm::abs(n);
    if (a.y >= a.x && a.y >= a.z) return 1;
    return a.x >= a.z ? 0 : 2;
}

// The texture axes of a box face: u, and the direction of decreasing v.
struct TextureAxes {
    Vec3 u, up;
};
TextureAxes texture_axes(int face) {
    if (face == 0) return {Vec3(0, 0, -1), Vec3(0, 1, 0)};
    if (face == 1) return {Vec3(1, 0, 0), Vec3(0, 0, -1)};
    return {Vec3(1, 0, 0), Vec3(0, 1, 0)};
}

}  // namespace

std::uint32_t SolidBuilder::vertex(int material, const Vec3& p, const Vec3& n, int face) {
    assets::Primitive& part = parts_[material];
    part.material = material;
    const TextureAxes axes = texture_axes(face);
    const double repeats = repeats_[static_cast<std::size_t>(material)];
    Vec3 tangent = axes.u - n * glm::dot(n, axes.u);
    if (glm::dot(tangent, tangent) < 1e-6) tangent = axes.up - n * glm::dot(n, axes.up);
    tangent = glm::normalize(tangent);
    const bool straight = glm::dot(glm::cross(n, tangent), axes.up) >= 0.0;
    part.positions.emplace_back(rounded(p, micron));
    part.normals.emplace_back(rounded(n, fine));
    part.tangents.emplace_back(glm::vec3(rounded(tangent, fine)), straight ? 1.0F : -1.0F);
    part.texcoords[0].emplace_back(glm::dvec2(rounded(glm::dot(p, axes.u) * repeats, fine),
                                              rounded(-glm::dot(p, axes.up) * repeats, fine)));
    return static_cast<std::uint32_t>(part.positions.size()) - 1;
}

void SolidBuilder::add_box(int material, const Vec3& centre, const Vec3& size, const Rounding& rounding) {
    const Vec3 half = 0.5 * size;
    const double radius = std::min({rounding.radius, half.x, half.y, half.z});
    const int n = rounding.segments;
    const Vec3 inner = half - Vec3(radius);
    // The grid lines in each direction of a face: the rounding in steps of angle, the flat, the rounding.
    struct GridLine {
        double side, slope;
    };
    std::vector<GridLine> lines;
    for (int i = 0; i <= n; ++i) lines.push_back({-1.0, std::tan(to_radians(-45.0 * (n - i) / n))});
    for (int i = 0; i <= n; ++i) lines.push_back({1.0, std::tan(to_radians(45.0 * i / n))});
    const std::size_t count = lines.size();
    for (int axis = 0; axis < 3; ++axis) {
        const int first = (axis + 1) % 3;
        const int second = (axis + 2) % 3;
        for (const double side : {-1.0, 1.0}) {
            std::vector<std::uint32_t> grid;
            for (const GridLine& b : lines) {
                for (const GridLine& a : lines) {
                    Vec3 normal(0.0);
                    normal[axis] = side;
                    normal[first] = a.slope;
                    normal[second] = b.slope;
                    normal = glm::normalize(normal);
                    Vec3 corner(0.0);
                    corner[axis] = side * inner[axis];
                    corner[first] = a.side * inner[first];
                    corner[second] = b.side * inner[second];
                    grid.push_back(vertex(material, centre + corner + normal * radius, normal, axis));
                }
            }
            std::vector<std::uint32_t>& indices = parts_[material].indices;
            for (std::size_t j = 0; j + 1 < count; ++j) {
                for (std::size_t i = 0; i + 1 < count; ++i) {
                    const std::uint32_t a = grid[j * count + i];
                    const std::uint32_t b = grid[j * count + i + 1];
                    const std::uint32_t c = grid[(j + 1) * count + i + 1];
                    const std::uint32_t d = grid[(j + 1) * count + i];
                    if (side > 0.0) {
                        indices.insert(indices.end(), {a, b, c, a, c, d});
                    } else {
                        indices.insert(indices.end(), {a, c, b, a, d, c});
                    }
                }
            }
        }
    }
}

void SolidBuilder::add_turned(int material, const Vec3& foot, std::span<const glm::dvec2> profile,
                              int segments, const Quat& turn) {
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
        const glm::dvec2 along = profile[k + 1] - profile[k];
        if (glm::dot(along, along) < 1e-18) continue;
        const glm::dvec2 out = glm::normalize(glm::dvec2(along.y, -along.x));
        std::vector<std::uint32_t> ring;
        for (int i = 0; i <= segments; ++i) {
            const double angle = 2.0 * pi * i / segments;
            const Vec3 away(std::cos(angle), 0.0, -std::sin(angle));
            const Vec3 normal = turn * (away * out.x + Vec3(0.0, out.y, 0.0));
            for (const glm::dvec2& point : {profile[k], profile[k + 1]}) {
                const Vec3 at = foot + turn * (away * point.x + Vec3(0.0, point.y, 0.0));
                ring.push_back(vertex(material, at, normal, dominant_axis(normal)));
            }
        }
        std::vector<std::uint32_t>& indices = parts_[material].indices;
        for (std::size_t i = 0; i < static_cast<std::size_t>(segments); ++i) {
            const std::uint32_t a = ring[2 * i];
            const std::uint32_t b = ring[2 * i + 2];
            const std::uint32_t c = ring[2 * i + 3];
            const std::uint32_t d = ring[2 * i + 1];
            if (profile[k].x > 0.0) indices.insert(indices.end(), {a, b, c});
            if (profile[k + 1].x > 0.0) indices.insert(indices.end(), {a, c, d});
        }
    }
}

void SolidBuilder::add_field(int material, const SignedDistanceField& field, const FieldBounds& box,
                             double cell, std::size_t triangles, const Vec3& position) {
    LabelledMesh fine_mesh;
    fine_mesh.mesh = extract(field, box, cell);
    for (Vec3& p : fine_mesh.mesh.positions) p = rounded(p, micron);
    fine_mesh.labels.assign(fine_mesh.mesh.triangles.size(), 0);
    const LabelledMesh coarse = simplify(fine_mesh, triangles);
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> vertex_of;
    std::vector<std::uint32_t> indices;
    for (const IndexTriangle& t : coarse.mesh.triangles) {
        const int face = dominant_axis(area_vector(coarse.mesh, t));
        for (const std::uint32_t v : t) {
            const auto [entry, is_new] = vertex_of.try_emplace({v, face}, 0U);
            if (is_new) {
                const Vec3& p = coarse.mesh.positions[v];
                const Vec3 normal = glm::normalize(gradient(field, p, 0.25 * cell));
                entry->second = vertex(material, p + position, normal, face);
            }
            indices.push_back(entry->second);
        }
    }
    std::vector<std::uint32_t>& all = parts_[material].indices;
    all.insert(all.end(), indices.begin(), indices.end());
}

void SolidBuilder::add_to(assets::Model& model, const std::string& name) {
    assets::Mesh mesh;
    mesh.name = name;
    for (auto& [material, part] : parts_) {
        const assets::Material& material_info = model.materials[static_cast<std::size_t>(material)];
        if (material_info.normal_texture.texture < 0) part.tangents.clear();
        const bool plain = material_info.base_color_texture.texture < 0 &&
                           material_info.normal_texture.texture < 0 &&
                           material_info.metallic_roughness_texture.texture < 0;
        if (plain) part.texcoords[0].clear();
        mesh.primitives.push_back(part);
    }
    parts_.clear();
    model.meshes.push_back(std::move(mesh));
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model.meshes.size()) - 1;
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
}

}  // namespace bolt::sculpt
