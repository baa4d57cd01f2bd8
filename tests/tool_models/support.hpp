// Checks of closed meshes for the tests of generated tools.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/assets/model.hpp"
#include "game/tool_models/parts.hpp"
#include "game/tool_models/tool_model.hpp"

namespace tool_models_test {

using namespace bolt;
using namespace bolt::tool_models;

// The number of directed edges that have no single opposite edge; 0 for a closed, consistently oriented mesh.
inline std::size_t unpaired_edges(const Shell& shell) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : shell.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    std::size_t unpaired = 0;
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        unpaired += count == 1 && opposite != edges.end() && opposite->second == 1 ? 0U : 1U;
    }
    return unpaired;
}

inline bool all_finite(const Shell& shell) {
    return std::all_of(shell.points.begin(), shell.points.end(), [](const Vec3& p) { return finite(p); });
}

// Standard parameters of a kind and a size, mm.
inline ToolParameters standard(ModelKind kind, double size_mm) {
    ToolParameters p;
    p.kind = kind;
    p.size = size_mm * mm;
    return *completed(p);
}

// The sizes of nuts in the tests, mm: the standard ones and every whole millimetre between them.
inline std::vector<double> nut_sizes() {
    const auto standard_ones = standard_sizes(SizeMeasure::nut);
    std::vector<double> sizes(standard_ones.begin(), standard_ones.end());
    for (int size = 6; size < sizes.back(); ++size)
        if (std::find(standard_ones.begin(), standard_ones.end(), size) == standard_ones.end())
            sizes.push_back(size);
    return sizes;
}

// Every kind in each of its sizes.
inline std::vector<ToolParameters> all_tools() {
    std::vector<ToolParameters> tools;
    for (const KindInfo& info : model_kinds()) {
        const auto listed = standard_sizes(info.measure);
        const std::vector<double> sizes = info.measure == SizeMeasure::nut
                                              ? nut_sizes()
                                              : std::vector<double>(listed.begin(), listed.end());
        for (const double size : sizes) tools.push_back(standard(info.kind, size));
    }
    return tools;
}

// The distance from `from` along `direction` (unit vector) to the first triangle of the shells; infinite:
// none.
inline double first_hit(const std::vector<Shell>& shells, const Vec3& from, const Vec3& direction) {
    double nearest = 1e9;
    for (const Shell& shell : shells)
        for (const auto& t : shell.triangles) {
            const Vec3 &a = shell.points[t[0]], &b = shell.points[t[1]], &c = shell.points[t[2]];
            const Vec3 normal = glm::cross(b - a, c - a);
            const double slope = glm::dot(normal, direction);
            if (std::abs(slope) < 1e-12) continue;
            const double along = glm::dot(normal, a - from) / slope;
            if (along < 0.0 || along >= nearest) continue;
            const Vec3 p = from + along * direction;
            const auto inside = [&](const Vec3& u, const Vec3& v) {
                return glm::dot(glm::cross(v - u, p - u), normal) >= -1e-9 * glm::dot(normal, normal);
            };
            if (inside(a, b) && inside(b, c) && inside(c, a)) nearest = along;
        }
    return nearest;
}

}  // namespace tool_models_test
