#include "tools/assets/sculpt/mesh.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <utility>

namespace bolt::sculpt {

double volume(const TriMesh& mesh) {
    double sum = 0.0;
    for (const IndexTriangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        sum += glm::dot(a, glm::cross(mesh.positions[t[1]], mesh.positions[t[2]]));
    }
    return sum / 6.0;
}

Vec3 area_vector(const TriMesh& mesh, const IndexTriangle& triangle) {
    const Vec3& a = mesh.positions[triangle[0]];
    return glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
}

std::size_t open_edges(const TriMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(mesh.triangles.size() * 3);
    for (const IndexTriangle& t : mesh.triangles) {
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
    std::map<std::array<double, 3>, std::uint32_t> index_of;
    std::vector<std::uint32_t> new_index(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        const auto next = static_cast<std::uint32_t>(out.positions.size());
        const auto [entry, is_new] = index_of.try_emplace({p.x, p.y, p.z}, next);
        if (is_new) out.positions.push_back(p);
        new_index[i] = entry->second;
    }
    for (const IndexTriangle& t : mesh.triangles) {
        const IndexTriangle welded{new_index[t[0]], new_index[t[1]], new_index[t[2]]};
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
    for (const IndexTriangle& t : mesh.triangles) {
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

namespace {

constexpr double snap = 0.25;  // as a fraction of the edge

bool opposite(double a, double b) { return (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0); }

void snap_to_line(TriMesh& mesh, std::vector<double>& values) {
    std::vector<double> nearest(values.size(), snap);
    std::vector<Vec3> target = mesh.positions;
    for (const IndexTriangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (const auto& [a, b] : {std::pair(t[i], t[(i + 1) % 3]), std::pair(t[(i + 1) % 3], t[i])}) {
                if (!opposite(values[a], values[b])) continue;
                const double part = values[a] / (values[a] - values[b]);
                if (part >= nearest[a]) continue;
                nearest[a] = part;
                target[a] = mesh.positions[a] + part * (mesh.positions[b] - mesh.positions[a]);
            }
        }
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (nearest[i] < snap) values[i] = 0.0;
    }
    mesh.positions = std::move(target);
}

}  // namespace

void cut(TriMesh& mesh, const std::function<double(const Vec3&)>& value) {
    std::vector<double> values;
    values.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) values.push_back(value(p));
    snap_to_line(mesh, values);

    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto split = [&](std::uint32_t a, std::uint32_t b) {
        const auto key = std::minmax(a, b);
        const auto next = static_cast<std::uint32_t>(mesh.positions.size());
        const auto [entry, is_new] = middle.try_emplace(std::pair(key.first, key.second), next);
        if (is_new) {
            const double part = values[key.first] / (values[key.first] - values[key.second]);
            mesh.positions.push_back(mesh.positions[key.first] +
                                     part * (mesh.positions[key.second] - mesh.positions[key.first]));
            values.push_back(0.0);
        }
        return entry->second;
    };
    std::vector<IndexTriangle> out;
    out.reserve(mesh.triangles.size());
    for (const IndexTriangle& t : mesh.triangles) {
        int crossed = 0;
        std::size_t whole = 0;  // the edge that is not crossed if the other two are
        for (std::size_t i = 0; i < 3; ++i) {
            if (opposite(values[t[i]], values[t[(i + 1) % 3]])) {
                ++crossed;
            } else {
                whole = i;
            }
        }
        if (crossed == 0) {
            out.push_back(t);
        } else if (crossed == 1) {
            std::size_t edge = 0;
            while (!opposite(values[t[edge]], values[t[(edge + 1) % 3]])) ++edge;
            const std::uint32_t a = t[edge];
            const std::uint32_t b = t[(edge + 1) % 3];
            const std::uint32_t c = t[(edge + 2) % 3];
            const std::uint32_t m = split(a, b);
            out.push_back({a, m, c});
            out.push_back({m, b, c});
        } else {
            const std::uint32_t a = t[whole];
            const std::uint32_t b = t[(whole + 1) % 3];
            const std::uint32_t tip = t[(whole + 2) % 3];
            const std::uint32_t mb = split(b, tip);
            const std::uint32_t ma = split(tip, a);
            out.push_back({ma, mb, tip});
            out.push_back({a, b, mb});
            out.push_back({a, mb, ma});
        }
    }
    mesh.triangles = std::move(out);
}

namespace {

// Removes pairs of triangles that lie back to back on the same three vertices. An edge collapse can fold the
// surface like this. The surface is closed without the pair.
void drop_folds(LabelledMesh& mesh) {
    const auto key = [](IndexTriangle t) {
        std::sort(t.begin(), t.end());
        return t;
    };
    std::map<IndexTriangle, int> count;
    for (const IndexTriangle& t : mesh.mesh.triangles) ++count[key(t)];
    LabelledMesh out;
    out.mesh.positions = std::move(mesh.mesh.positions);
    for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
        if (count[key(mesh.mesh.triangles[i])] > 1) continue;
        out.mesh.triangles.push_back(mesh.mesh.triangles[i]);
        out.labels.push_back(mesh.labels[i]);
    }
    mesh = std::move(out);
}

}  // namespace

LabelledMesh simplify(const LabelledMesh& fine, std::size_t target) {
    // Duplicate a vertex on the line between two labels for each label: the simplifier treats the line as a
    // seam and collapses it only along itself.
    std::map<std::pair<int, std::uint32_t>, unsigned> index_of;
    std::vector<std::uint32_t> origin;
    std::vector<int> label_of;
    std::vector<glm::vec3> positions;
    std::vector<unsigned> indices;
    for (std::size_t t = 0; t < fine.mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : fine.mesh.triangles[t]) {
            const auto next = static_cast<unsigned>(origin.size());
            const auto [entry, is_new] = index_of.try_emplace({fine.labels[t], v}, next);
            if (is_new) {
                origin.push_back(v);
                label_of.push_back(fine.labels[t]);
                positions.emplace_back(fine.mesh.positions[v]);
            }
            indices.push_back(entry->second);
        }
    }
    std::vector<unsigned> kept(indices.size());
    kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), &positions[0].x,
                                 positions.size(), sizeof(glm::vec3), target * 3, 1.0F, 0, nullptr));
    meshopt_optimizeVertexCache(kept.data(), kept.data(), kept.size(), positions.size());

    LabelledMesh out;
    std::map<std::uint32_t, std::uint32_t> new_index;
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        IndexTriangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = origin[kept[i + k]];
            const auto next = static_cast<std::uint32_t>(out.mesh.positions.size());
            const auto [entry, is_new] = new_index.try_emplace(from, next);
            if (is_new) out.mesh.positions.push_back(fine.mesh.positions[from]);
            triangle[k] = entry->second;
        }
        out.mesh.triangles.push_back(triangle);
        out.labels.push_back(label_of[kept[i]]);
    }
    drop_folds(out);
    return out;
}

}  // namespace bolt::sculpt
