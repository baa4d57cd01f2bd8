#include "tools/assets/sculpt/cut.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace bolt::sculpt {
namespace {

constexpr double snap = 0.25;  // of an edge

bool opposite(double a, double b) { return (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0); }

void snap_to_line(TriMesh& mesh, std::vector<double>& values) {
    std::vector<double> nearest(values.size(), snap);
    std::vector<Vec3> target = mesh.positions;
    for (const Triangle& t : mesh.triangles) {
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
        const auto [entry, fresh] = middle.try_emplace(std::pair(key.first, key.second), next);
        if (fresh) {
            const double part = values[key.first] / (values[key.first] - values[key.second]);
            mesh.positions.push_back(mesh.positions[key.first] +
                                     part * (mesh.positions[key.second] - mesh.positions[key.first]));
            values.push_back(0.0);
        }
        return entry->second;
    };
    std::vector<Triangle> out;
    out.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        int crossed = 0;
        std::size_t whole = 0;  // the edge that is not crossed, when two are
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

}  // namespace bolt::sculpt
