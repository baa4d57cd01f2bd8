#include "tools/author/geometry/watertight.hpp"

#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace bolt::geometry {

OpenEdges open_edges(std::span<const Triangle> triangles) {
    std::map<std::tuple<double, double, double>, std::uint32_t> index;
    std::vector<Vec3> points;
    const auto weld = [&](const Vec3& p) {
        const auto [it, fresh] =
            index.emplace(std::tuple{p.x, p.y, p.z}, static_cast<std::uint32_t>(points.size()));
        if (fresh) points.push_back(p);
        return it->second;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, long>
        uses;  // lower corner first; + forward, - backward
    for (const Triangle& t : triangles) {
        const std::uint32_t corners[3] = {weld(t.a), weld(t.b), weld(t.c)};
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
            if (a < b) ++uses[{a, b}];
            if (b < a) --uses[{b, a}];
        }
    }
    OpenEdges open;
    for (const auto& [edge, balance] : uses) {
        if (balance == 0) continue;
        if (open.count == 0) open.first = 0.5 * (points[edge.first] + points[edge.second]);
        open.count += static_cast<std::size_t>(std::abs(balance));
    }
    return open;
}

}  // namespace bolt::geometry
