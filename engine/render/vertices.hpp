// A primitive's vertices as the GPU takes them.
#pragma once

#include "engine/render/gpu_model.hpp"

namespace bolt::render {

struct Vertices {
    std::vector<glm::vec3> positions;
    std::vector<VertexAttributes> attributes;
    std::vector<std::uint32_t> indices;
};

// Triangles of any topology. Without normals every triangle gets corners of its own.
Vertices make_vertices(const assets::Primitive& primitive);

}  // namespace bolt::render
