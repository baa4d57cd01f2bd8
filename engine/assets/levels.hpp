// Coarser versions of a mesh over the same vertices, by meshoptimizer's quadric simplification: only index
// lists are new.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::assets {

struct Level {
    std::vector<std::uint32_t> indices;
    float error = 0.0F;  // m: how far its surface may be from the finest
};

struct LevelOptions {
    std::size_t levels = 4;   // at most
    std::size_t least = 600;  // indices below which nothing is made coarser
    float most_error = 0.1F;  // of the mesh's size
    float worthwhile = 0.7F;  // a level has at most this share of the indices of the one before
};

// Each level has about a third of the triangles of the one before; fewer levels where the shape doesn't give
// more. Vertices that share a position with others of another normal (sharp edges) stay on their edge.
std::vector<Level> coarser_levels(std::span<const glm::vec3> positions,
                                  std::span<const std::uint32_t> indices, const LevelOptions& options = {});

}  // namespace bolt::assets
