#include "engine/render/vertices.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

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

VertexAttributes attributes_of(const assets::Primitive& p, std::uint32_t i, const glm::vec3& normal,
                               const std::vector<glm::vec4>& tangents) {
    VertexAttributes a{};
    set(a.normal, normal, 0.0F);
    if (!tangents.empty()) set(a.tangent, glm::vec3(tangents[i]), tangents[i].w);
    if (!p.texcoords[0].empty()) {
        a.texcoord[0] = p.texcoords[0][i].x;
        a.texcoord[1] = p.texcoords[0][i].y;
    }
    const glm::vec4 color = p.colors.empty() ? glm::vec4(1.0F) : glm::clamp(p.colors[i], 0.0F, 1.0F);
    for (int c = 0; c < 4; ++c) a.color[c] = static_cast<std::uint8_t>(std::lround(color[c] * 255.0F));
    return a;
}

// Brushed metal needs a direction along the surface; for normal maps the shader derives one.
bool wants_tangents(const assets::Primitive& p, const assets::Material& material, std::size_t set) {
    return p.tangents.empty() && material.anisotropy > 0.0F && !p.texcoords[set].empty();
}

}  // namespace

void copy_with_normal(Vertices& v, std::uint32_t of, const glm::vec3& normal) {
    v.positions.push_back(glm::vec3(v.positions[of]));
    v.sources.push_back(std::uint32_t{v.sources[of]});
    v.attributes.push_back(VertexAttributes(v.attributes[of]));
    set(v.attributes.back().normal, normal, 0.0F);
}

std::vector<glm::vec4> make_tangents(const assets::Primitive& p, std::size_t set) {
    const std::vector<std::uint32_t> triangles = assets::triangle_indices(p);
    const std::vector<glm::vec2>& uv = p.texcoords[set];
    std::vector<glm::vec3> along(p.positions.size(), glm::vec3(0.0F)), up(along);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
        const glm::vec2 u = uv[b] - uv[a], v = uv[c] - uv[a];
        const glm::vec3 x = p.positions[b] - p.positions[a], y = p.positions[c] - p.positions[a];
        // Divide only by the sign of the triangle's texture area, so that large triangles have more weight.
        const float side = u.x * v.y - u.y * v.x < 0.0F ? -1.0F : 1.0F;
        for (const std::uint32_t corner : {a, b, c}) {
            along[corner] += side * (x * v.y - y * u.y);
            up[corner] -= side * (y * u.x - x * v.x);  // against v, which grows downwards
        }
    }
    std::vector<glm::vec4> tangents;
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const glm::vec3 n = p.normals.empty() ? glm::vec3(0.0F) : p.normals[i];
        const glm::vec3 t = along[i] - glm::dot(along[i], n) * n;
        const float length = glm::length(t);
        const float side = glm::dot(glm::cross(n, t), up[i]) < 0.0F ? -1.0F : 1.0F;
        tangents.emplace_back(length > 0.0F ? t / length : glm::vec3(0.0F), side);
    }
    return tangents;
}

Vertices make_vertices(const assets::Primitive& p, const assets::Material& material) {
    Vertices v;
    const std::vector<std::uint32_t> triangles = assets::triangle_indices(p);
    const auto uv_set = static_cast<std::size_t>(material.normal_texture.texcoord & 1);
    const std::vector<glm::vec4> made =
        wants_tangents(p, material, uv_set) ? make_tangents(p, uv_set) : std::vector<glm::vec4>();
    const std::vector<glm::vec4>& tangents = p.tangents.empty() ? made : p.tangents;
    v.tangents = !tangents.empty();
    if (!p.normals.empty()) {
        v.positions = p.positions;
        v.indices = triangles;
        v.sources.resize(p.positions.size());
        std::iota(v.sources.begin(), v.sources.end(), 0U);
        v.attributes.reserve(p.positions.size());
        for (const std::uint32_t i : v.sources)
            v.attributes.push_back(attributes_of(p, i, p.normals[i], tangents));
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
            const std::uint32_t source = triangles[t + k];
            v.indices.push_back(static_cast<std::uint32_t>(v.positions.size()));
            v.positions.push_back(p.positions[source]);
            v.sources.push_back(source);
            v.attributes.push_back(attributes_of(p, source, normal, tangents));
        }
    }
    return v;
}

}  // namespace bolt::render
