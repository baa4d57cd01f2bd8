#include "tools/assets/sculpt/solid.hpp"

#include <algorithm>
#include <cmath>

#include "tools/assets/sculpt/mesh.hpp"
#include "tools/assets/sculpt/quantise.hpp"

namespace bolt::sculpt {
namespace {

int widest(const Vec3& n) {
    const Vec3 a = glm::abs(n);
    if (a.y >= a.x && a.y >= a.z) return 1;
    return a.x >= a.z ? 0 : 2;
}

// The axes along which a face's texture runs: u, and the direction in which v falls.
struct Laying {
    Vec3 u, up;
};
Laying laying(int face) {
    if (face == 0) return {Vec3(0, 0, -1), Vec3(0, 1, 0)};
    if (face == 1) return {Vec3(1, 0, 0), Vec3(0, 0, -1)};
    return {Vec3(1, 0, 0), Vec3(0, 1, 0)};
}

}  // namespace

std::uint32_t Solid::vertex(int material, const Vec3& p, const Vec3& n, int face) {
    assets::Primitive& part = parts_[material];
    part.material = material;
    const Laying lay = laying(face);
    const double repeats = repeats_[static_cast<std::size_t>(material)];
    Vec3 tangent = lay.u - n * glm::dot(n, lay.u);
    if (glm::dot(tangent, tangent) < 1e-6) tangent = lay.up - n * glm::dot(n, lay.up);
    tangent = glm::normalize(tangent);
    const bool straight = glm::dot(glm::cross(n, tangent), lay.up) >= 0.0;
    part.positions.emplace_back(rounded(p, micron));
    part.normals.emplace_back(rounded(n, fine));
    part.tangents.emplace_back(glm::vec3(rounded(tangent, fine)), straight ? 1.0F : -1.0F);
    part.texcoords[0].emplace_back(glm::dvec2(rounded(glm::dot(p, lay.u) * repeats, fine),
                                              rounded(-glm::dot(p, lay.up) * repeats, fine)));
    return static_cast<std::uint32_t>(part.positions.size()) - 1;
}

void Solid::box(int material, const Vec3& centre, const Vec3& size, const Rounding& rounding) {
    const Vec3 half = 0.5 * size;
    const double radius = std::min({rounding.radius, half.x, half.y, half.z});
    const int n = rounding.segments;
    const Vec3 inner = half - Vec3(radius);
    // Along each direction of a face: the rounding in steps of angle, the flat, the rounding again.
    struct Step {
        double side, slope;
    };
    std::vector<Step> steps;
    for (int i = 0; i <= n; ++i) steps.push_back({-1.0, std::tan(to_radians(-45.0 * (n - i) / n))});
    for (int i = 0; i <= n; ++i) steps.push_back({1.0, std::tan(to_radians(45.0 * i / n))});
    const std::size_t count = steps.size();
    for (int axis = 0; axis < 3; ++axis) {
        const int first = (axis + 1) % 3;
        const int second = (axis + 2) % 3;
        for (const double side : {-1.0, 1.0}) {
            std::vector<std::uint32_t> grid;
            for (const Step& b : steps) {
                for (const Step& a : steps) {
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

void Solid::turned(int material, const Vec3& foot, std::span<const glm::dvec2> profile, int segments,
                   const Quat& turn) {
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
                ring.push_back(vertex(material, at, normal, widest(normal)));
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

void Solid::sculpted(int material, const Field& field, const Box& box, double cell, std::size_t triangles,
                     const Vec3& place) {
    LabelledMesh fine_mesh;
    fine_mesh.mesh = extract(field, box, cell);
    for (Vec3& p : fine_mesh.mesh.positions) p = rounded(p, micron);
    fine_mesh.labels.assign(fine_mesh.mesh.triangles.size(), 0);
    const LabelledMesh coarse = simplify(fine_mesh, triangles);
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> known;
    std::vector<std::uint32_t> indices;
    for (const Triangle& t : coarse.mesh.triangles) {
        const int face = widest(area_vector(coarse.mesh, t));
        for (const std::uint32_t v : t) {
            const auto [entry, fresh] = known.try_emplace({v, face}, 0U);
            if (fresh) {
                const Vec3& p = coarse.mesh.positions[v];
                const Vec3 normal = glm::normalize(gradient(field, p, 0.25 * cell));
                entry->second = vertex(material, p + place, normal, face);
            }
            indices.push_back(entry->second);
        }
    }
    std::vector<std::uint32_t>& all = parts_[material].indices;
    all.insert(all.end(), indices.begin(), indices.end());
}

void Solid::add_to(assets::Model& model, const std::string& name) {
    assets::Mesh mesh;
    mesh.name = name;
    for (auto& [material, part] : parts_) {
        const assets::Material& look = model.materials[static_cast<std::size_t>(material)];
        if (look.normal_texture.texture < 0) part.tangents.clear();
        const bool plain = look.base_color_texture.texture < 0 && look.normal_texture.texture < 0 &&
                           look.metallic_roughness_texture.texture < 0;
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

std::size_t Solid::triangles() const {
    std::size_t count = 0;
    for (const auto& [material, part] : parts_) count += part.indices.size() / 3;
    return count;
}

}  // namespace bolt::sculpt
