#include "tools/assets/sculpt/mesh.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace bolt::sculpt {

double volume(const TriMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        sum += glm::dot(a, glm::cross(mesh.positions[t[1]], mesh.positions[t[2]]));
    }
    return sum / 6.0;
}

Vec3 area_vector(const TriMesh& mesh, const Triangle& triangle) {
    const Vec3& a = mesh.positions[triangle[0]];
    return glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
}

std::size_t open_edges(const TriMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(mesh.triangles.size() * 3);
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    std::size_t open = 0;
    for (const auto& edge : edges) {
        const auto same = std::equal_range(edges.begin(), edges.end(), edge);
        const auto opposite =
            std::equal_range(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
        if (same.second - same.first != 1 || opposite.second - opposite.first != 1) ++open;
    }
    return open;
}

TriMesh weld(const TriMesh& mesh) {
    TriMesh out;
    std::map<std::array<double, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> place(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        const auto next = static_cast<std::uint32_t>(out.positions.size());
        const auto [entry, fresh] = known.try_emplace({p.x, p.y, p.z}, next);
        if (fresh) out.positions.push_back(p);
        place[i] = entry->second;
    }
    for (const Triangle& t : mesh.triangles) {
        const Triangle welded{place[t[0]], place[t[1]], place[t[2]]};
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
        out.triangles.push_back(welded);
    }
    return out;
}

void relax_tangentially(TriMesh& mesh, double strength) {
    const std::size_t count = mesh.positions.size();
    std::vector<Vec3> normals(count, Vec3(0.0));
    std::vector<Vec3> sums(count, Vec3(0.0));
    std::vector<double> valence(count, 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 area = area_vector(mesh, t);
        for (std::size_t i = 0; i < 3; ++i) {
            normals[t[i]] += area;
            sums[t[i]] += mesh.positions[t[(i + 1) % 3]] + mesh.positions[t[(i + 2) % 3]];
            valence[t[i]] += 2.0;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double length2 = glm::dot(normals[i], normals[i]);
        if (valence[i] == 0.0 || length2 == 0.0) continue;
        Vec3 step = (sums[i] / valence[i] - mesh.positions[i]) * strength;
        step -= normals[i] * (glm::dot(step, normals[i]) / length2);
        mesh.positions[i] += step;
    }
}

}  // namespace bolt::sculpt
