// Generates coarser levels of detail with meshoptimizer's quadric simplification (M. Garland and P. Heckbert,
// Surface Simplification Using Quadric Error Metrics, 1997).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::assets {

// A copy of a vertex with another normal.
struct AddedVertex {
    std::uint32_t source = 0;  // index of the copied vertex
    glm::vec3 normal{0.0F};
};

struct LevelOfDetail {
    std::vector<std::uint32_t> indices;  // indices of the mesh's vertices, then of `added`
    std::vector<AddedVertex> added;
    float error = 0.0F;  // m: estimated largest distance from the finest level, summed over the levels
};

struct LevelOptions {
    std::size_t levels = 6;         // maximum number of levels
    std::size_t min_indices = 600;  // meshes with fewer indices are not simplified
    float max_error = 0.1F;         // from one level to the next, as a fraction of the mesh's size
    float max_ratio = 0.75F;        // a level has at most this fraction of the previous level's indices
    float crease = 1.05F;           // rad; a larger angle between faces is a hard edge
    bool weld = true;               // merge vertices at one position, whatever their other attributes
    float max_normal_error = 0.1F;  // rad; a normal that deviates more from its faces is replaced
};

// Returns the levels below the finest one. Each has about half the triangles of the previous one; there are
// fewer levels if the mesh cannot be simplified further.
//
// With `weld`, the mesh is simplified regardless of attribute seams, and every corner uses the vertex whose
// normal is nearest to that of its face. Without `weld`, vertices that share a position stay on their seam;
// use this for deformable and textured meshes. Where a normal deviates too much from its faces (where a
// fillet was removed, or at the edge of a flat face), a vertex with a corrected normal is added. Without
// normals, no vertices are added or welded.
std::vector<LevelOfDetail> coarser_levels(std::span<const glm::vec3> positions,
                                          std::span<const glm::vec3> normals,
                                          std::span<const std::uint32_t> indices,
                                          const LevelOptions& options = {});

}  // namespace bolt::assets
