// Coarser versions of a mesh, by meshoptimizer's quadric simplification.
//   M. Garland and P. Heckbert, Surface Simplification Using Quadric Error Metrics, 1997.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::assets {

// A vertex as the mesh has it, with another normal.
struct AddedVertex {
    std::uint32_t of = 0;
    glm::vec3 normal{0.0F};
};

struct Level {
    std::vector<std::uint32_t> indices;  // of the mesh's vertices; above them, of `added`
    std::vector<AddedVertex> added;
    float error = 0.0F;  // m: how far its surface may be from the finest
};

struct LevelOptions {
    std::size_t levels = 6;    // at most
    std::size_t least = 600;   // indices below which nothing is made coarser
    float most_error = 0.1F;   // of the mesh's size
    float worthwhile = 0.75F;  // a level has at most this share of the indices of the one before
    float crease = 1.05F;      // rad; faces that meet at more than this have an edge between them
    bool weld = true;          // vertices at one place are one, whatever else they say
    float turned = 0.1F;       // rad; a normal that is further from its faces than this is made anew
};

// Each level has about half the triangles of the one before; fewer levels where the shape doesn't give more.
//
// Welded, the mesh is simplified as a shape, whatever its vertices say at hard edges, and every corner takes
// the vertex that faces as it does; otherwise vertices that share a position with others stay on their edge,
// which is for what bends and what has maps. Where a normal no longer fits the triangles around (of a fillet
// that is gone, at the rim of a flat), there is a new vertex with one that does. Without normals there are
// none, and nothing is welded.
std::vector<Level> coarser_levels(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                  std::span<const std::uint32_t> indices, const LevelOptions& options = {});

}  // namespace bolt::assets
