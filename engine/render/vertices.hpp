// A primitive's vertices as the GPU takes them.
#pragma once

#include "engine/render/gpu_model.hpp"

namespace bolt::render {

struct Vertices {
    std::vector<glm::vec3> positions;
    std::vector<VertexAttributes> attributes;
    std::vector<std::uint32_t> sources;  // the primitive's vertex that each comes from
    std::vector<std::uint32_t> indices;
    bool tangents = false;
};

// Triangles of any topology. Without normals every triangle gets corners of its own. `material` decides
// whether tangents are made where there are none.
Vertices make_vertices(const assets::Primitive& primitive, const assets::Material& material);

// Appends a vertex that is another one with its own normal.
void copy_with_normal(Vertices& vertices, std::uint32_t of, const glm::vec3& normal);

// The direction of growing u at every vertex; w: on which side v falls (glTF 2.0, 3.7.2.1: the bitangent is
// the cross product of normal and tangent, times w).
std::vector<glm::vec4> make_tangents(const assets::Primitive& primitive, std::size_t texcoord_set);

}  // namespace bolt::render
