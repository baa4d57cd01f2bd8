#include "tools/bench/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "engine/assets/gltf.hpp"
#include "engine/assets/topology.hpp"
#include "engine/base/minimum_jerk.hpp"
#include "engine/base/random.hpp"
#include "haptics/collision/narrow_phase.hpp"

namespace bolt::bench {
namespace {

using collision::ContactMesh;

Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}

Vec3 random_point(Random& random, const ContactMesh& mesh, const std::vector<double>& sums, Vec3& normal) {
    const auto above = std::upper_bound(sums.begin(), sums.end(), random.uniform() * sums.back());
    const auto t = std::min(mesh.triangles.size() - 1, static_cast<std::size_t>(above - sums.begin()));
    const auto [a, b, c] = corners(mesh, t);
    normal = Vec3(mesh.face_normals[t]);
    const double u = std::sqrt(random.uniform());
    const double v = random.uniform();
    return a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v);
}

std::vector<double> area_sums(const ContactMesh& mesh) {
    std::vector<double> sums;
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners(mesh, t);
        sums.push_back(area += glm::length(glm::cross(b - a, c - a)));
    }
    return sums;
}

}  // namespace

Result<std::vector<ContactMesh>> load_contact(const std::filesystem::path& path,
                                              const std::vector<std::string>& prefixes) {
    BOLT_TRY_ASSIGN(const auto model, assets::read_gltf(path));
    const std::vector<glm::mat4> world = assets::world_transforms(model);
    std::vector<ContactMesh> parts;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        const assets::Node& node = model.nodes[n];
        const auto named = [&](const std::string& prefix) { return node.name.starts_with(prefix); };
        if (node.mesh < 0 || (!prefixes.empty() && std::none_of(prefixes.begin(), prefixes.end(), named)))
            continue;
        std::vector<glm::vec3> vertices;
        std::vector<std::uint32_t> indices;
        for (const assets::Primitive& primitive :
             model.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            const auto first = static_cast<std::uint32_t>(vertices.size());
            for (const glm::vec3& v : primitive.positions)
                vertices.emplace_back(glm::dmat4(world[n]) * glm::dvec4(v, 1.0));
            for (const std::uint32_t i : assets::triangle_indices(primitive)) indices.push_back(first + i);
        }
        BOLT_TRY_ASSIGN(auto mesh, collision::make_contact_mesh(vertices, indices));
        parts.push_back(std::move(mesh));
    }
    return parts;
}

ContactMesh refined(const ContactMesh& mesh, double longest) {
    std::vector<glm::vec3> vertices = mesh.vertices;
    std::vector<glm::vec3> normals = mesh.vertex_normals;
    auto triangles = mesh.triangles;
    for (bool again = true; again;) {
        again = false;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> halves;
        const auto half = [&](std::uint32_t a, std::uint32_t b) -> std::uint32_t {
            if (glm::length(Vec3(vertices[a]) - Vec3(vertices[b])) <= longest) return 0xffffffffU;
            const auto [at, is_new] =
                halves.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
            if (is_new) {
                const glm::vec3 normal = glm::normalize(normals[a] + normals[b] + glm::vec3(1e-12F));
                vertices.push_back(0.5F * (vertices[a] + vertices[b]));
                normals.push_back(normal);
            }
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& t : triangles) {
            std::array<std::uint32_t, 3> m{};
            std::size_t count = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                m[i] = half(t[i], t[(i + 1) % 3]);
                count += m[i] != 0xffffffffU ? 1U : 0U;
            }
            if (count == 0) {
                finer.push_back(t);
                continue;
            }
            again = true;
            std::size_t i = 0;  // the first edge of the pattern
            if (count == 1)
                while (m[i] == 0xffffffffU) ++i;
            if (count == 2)
                while (m[(i + 2) % 3] != 0xffffffffU) ++i;
            const std::uint32_t a = t[i % 3];
            const std::uint32_t b = t[(i + 1) % 3];
            const std::uint32_t c = t[(i + 2) % 3];
            const std::uint32_t ab = m[i % 3];
            const std::uint32_t bc = m[(i + 1) % 3];
            const std::uint32_t ca = m[(i + 2) % 3];
            if (count == 1) {
                finer.insert(finer.end(), {{a, ab, c}, {ab, b, c}});
            } else if (count == 2) {
                finer.insert(finer.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
            } else {
                finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
            }
        }
        triangles = std::move(finer);
    }
    for (std::size_t v = mesh.vertices.size(); v < vertices.size(); ++v) {
        const Vec3 waves = Vec3(vertices[v]) * (2.0 * pi / 20e-3);
        const double shift = 20e-6 * std::sin(waves.x) * std::sin(waves.y + 1.0) * std::sin(waves.z + 2.0);
        vertices[v] += static_cast<float>(shift) * normals[v];
    }
    std::vector<std::uint32_t> indices;
    for (const auto& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
    return collision::make_contact_mesh(vertices, indices).value();
}

std::vector<Pose> make_sweep(const collision::World& world, const collision::Solid& casing,
                             const collision::ToolShape& tool, double deepest, double seconds) {
    Random random(7);
    const std::vector<double> casing_sums = area_sums(casing.mesh);
    const std::vector<double> tool_sums = area_sums(tool.solid.mesh);
    collision::NarrowPhaseState state = collision::make_narrow_phase(world, tool);
    // Pushes out along the deepest contact repeatedly and returns slowly: nearly the motion of a god-object.
    Vec3 shift(0.0);
    const auto put = [&](Pose pose) -> std::optional<Pose> {
        shift *= 0.98;
        pose.position += shift;
        for (int i = 0; i < 60; ++i) {
            std::array<collision::Contact, 32> contacts;
            const collision::ContactQueryResult found =
                find_contacts(world, tool, pose, 1e-4, state, contacts);
            if (found.count == 0 || contacts[0].distance >= -deepest) return pose;
            const Vec3 out = (-contacts[0].distance - 0.5 * deepest) * contacts[0].normal;
            shift += out;
            pose.position += out;
            if (glm::length(shift) > 12e-3) break;
        }
        return std::nullopt;
    };
    const auto leg = [&](const Pose& from, const Pose& to) {
        std::vector<Pose> poses;
        // No point of the tool is faster than 0.3 m/s.
        const double turn = glm::length(rotation_vector(glm::conjugate(from.orientation) * to.orientation));
        const double length = glm::length(to.position - from.position) + tool.reach() * turn;
        const int steps = 1 + static_cast<int>(1e3 * std::max(0.2, 1.875 * length / 0.3));
        for (int i = 0; i < steps; ++i) {
            const double t = static_cast<double>(i) / steps;
            const double s = minimum_jerk(t);
            const std::optional<Pose> placed = put(
                {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)});
            if (!placed) return std::vector<Pose>{};
            poses.push_back(*placed);
        }
        return poses;
    };
    std::vector<Pose> sweep;
    Pose from{casing.middle + Vec3(0.0, 2.0 * casing.radius, 0.0), Quat(1.0, 0.0, 0.0, 0.0)};
    while (static_cast<double>(sweep.size()) < 1e3 * seconds) {
        Vec3 normal(0.0);
        Vec3 tool_normal(0.0);
        const Vec3 at = random_point(random, casing.mesh, casing_sums, normal);
        const Vec3 on_tool = random_point(random, tool.solid.mesh, tool_sums, tool_normal);
        Pose there{at + random.uniform(-8e-3, 4e-3) * normal, random_turn(random)};
        there.position -= there.orientation * on_tool;
        // There along the normal, a bit along the surface, and back.
        const Pose before{there.position + 25e-3 * normal, there.orientation};
        const Vec3 along = glm::normalize(glm::cross(normal, Vec3(random.normal(), random.normal(), 0.3)));
        const Pose after{there.position + 15e-3 * along, rotation(0.2 * normal) * there.orientation};
        std::vector<Pose> way;
        shift = Vec3(0.0);
        bool allowed = true;
        for (const auto& [a, b] :
             {std::pair(from, before), std::pair(before, there), std::pair(there, after)}) {
            // Far ways are not the point: the tool is put there.
            if (glm::length(a.position - b.position) > 0.1) continue;
            const std::vector<Pose> part = leg(a, b);
            allowed = allowed && !part.empty();
            way.insert(way.end(), part.begin(), part.end());
        }
        if (!allowed) continue;
        sweep.insert(sweep.end(), way.begin(), way.end());
        from = after;
    }
    return sweep;
}

}  // namespace bolt::bench
