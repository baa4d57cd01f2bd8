#include "engine/render/vertices.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/assets/topology.hpp"

namespace bolt::render {

namespace {

std::int16_t snorm(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0F, 1.0F) * 32767.0F));
}

void set(std::int16_t (&to)[4], const glm::vec3& v, float w) {
    to[0] = snorm(v.x);
    to[1] = snorm(v.y);
    to[2] = snorm(v.z);
    to[3] = snorm(w);
}

VertexAttributes attributes_of(const assets::Primitive& p, std::uint32_t i, const glm::vec3& normal) {
    VertexAttributes a{};
    set(a.normal, normal, 0.0F);
    if (!p.tangents.empty()) set(a.tangent, glm::vec3(p.tangents[i]), p.tangents[i].w);
    if (!p.texcoords[0].empty()) {
        a.texcoord[0] = p.texcoords[0][i].x;
        a.texcoord[1] = p.texcoords[0][i].y;
    }
    const glm::vec4 color = p.colors.empty() ? glm::vec4(1.0F) : glm::clamp(p.colors[i], 0.0F, 1.0F);
    for (int c = 0; c < 4; ++c) a.color[c] = static_cast<std::uint8_t>(std::lround(color[c] * 255.0F));
    return a;
}

}  // namespace

Vertices make_vertices(const assets::Primitive& p) {
    Vertices v;
    const std::vector<std::uint32_t> triangles = assets::triangle_indices(p);
    if (!p.normals.empty()) {
        v.positions = p.positions;
        v.attributes.reserve(p.positions.size());
        for (std::uint32_t i = 0; i < p.positions.size(); ++i)
            v.attributes.push_back(attributes_of(p, i, p.normals[i]));
        v.indices = triangles;
        return v;
    }
    v.positions.reserve(triangles.size());
    v.attributes.reserve(triangles.size());
    v.indices.reserve(triangles.size());
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::vec3 a = p.positions[triangles[t]], b = p.positions[triangles[t + 1]],
                        c = p.positions[triangles[t + 2]];
        const glm::vec3 across = glm::cross(b - a, c - a);
        const float area = glm::length(across);
        const glm::vec3 normal = area > 0.0F ? across / area : glm::vec3(0.0F, 1.0F, 0.0F);
        for (std::size_t k = 0; k < 3; ++k) {
            v.indices.push_back(static_cast<std::uint32_t>(v.positions.size()));
            v.positions.push_back(p.positions[triangles[t + k]]);
            v.attributes.push_back(attributes_of(p, triangles[t + k], normal));
        }
    }
    return v;
}

}  // namespace bolt::render
