#include "tools/assets/sculpt/simplify.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <glm/vec3.hpp>
#include <map>
#include <utility>

namespace bolt::sculpt {
namespace {

// Now and then a collapse folds the surface flat: two triangles back to back on the same three vertices, and
// an edge with four. Without the pair the surface is whole again.
void drop_folds(LabelledMesh& mesh) {
    const auto key = [](Triangle t) {
        std::sort(t.begin(), t.end());
        return t;
    };
    std::map<Triangle, int> count;
    for (const Triangle& t : mesh.mesh.triangles) ++count[key(t)];
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
    // A vertex on the line between two labels stands once for each: the simplifier takes that for a seam and
    // collapses it only along itself.
    std::map<std::pair<int, std::uint32_t>, unsigned> known;
    std::vector<std::uint32_t> origin;
    std::vector<int> label_of;
    std::vector<glm::vec3> positions;
    std::vector<unsigned> indices;
    for (std::size_t t = 0; t < fine.mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : fine.mesh.triangles[t]) {
            const auto next = static_cast<unsigned>(origin.size());
            const auto [entry, fresh] = known.try_emplace({fine.labels[t], v}, next);
            if (fresh) {
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
    std::map<std::uint32_t, std::uint32_t> place;
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = origin[kept[i + k]];
            const auto next = static_cast<std::uint32_t>(out.mesh.positions.size());
            const auto [entry, fresh] = place.try_emplace(from, next);
            if (fresh) out.mesh.positions.push_back(fine.mesh.positions[from]);
            triangle[k] = entry->second;
        }
        out.mesh.triangles.push_back(triangle);
        out.labels.push_back(label_of[kept[i]]);
    }
    drop_folds(out);
    return out;
}

}  // namespace bolt::sculpt
