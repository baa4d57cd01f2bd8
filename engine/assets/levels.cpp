#include "engine/assets/levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>

namespace bolt::assets {

std::vector<Level> coarser_levels(std::span<const glm::vec3> positions,
                                  std::span<const std::uint32_t> indices, const LevelOptions& options) {
    std::vector<Level> levels;
    if (positions.empty() || indices.size() < options.least) return levels;
    const float* first = &positions.front().x;
    const float size = meshopt_simplifyScale(first, positions.size(), sizeof(glm::vec3));
    std::span<const std::uint32_t> from = indices;
    float error = 0.0F;  // errors of steps add up
    while (levels.size() < options.levels && from.size() >= options.least) {
        Level level;
        level.indices.resize(from.size());
        float reached = 0.0F;
        const std::size_t wanted = from.size() / 9 * 3;
        level.indices.resize(meshopt_simplify(level.indices.data(), from.data(), from.size(), first,
                                              positions.size(), sizeof(glm::vec3), wanted, options.most_error,
                                              0, &reached));
        const auto worthwhile =
            static_cast<std::size_t>(options.worthwhile * static_cast<float>(from.size()));
        if (level.indices.empty() || level.indices.size() > worthwhile) break;
        meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                    positions.size());
        error += reached * size;
        level.error = error;
        levels.push_back(std::move(level));
        from = levels.back().indices;
    }
    return levels;
}

}  // namespace bolt::assets
