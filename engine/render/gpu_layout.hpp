// Converts vertices, materials and textures to the layout that the shaders read.
#pragma once

#include <array>
#include <vector>

#include "engine/render/gpu_model.hpp"

namespace bolt::render {

struct Vertices {
    std::vector<glm::vec3> positions;
    std::vector<VertexAttributes> attributes;
    std::vector<std::uint32_t> sources;  // for each vertex, the primitive's vertex that it was made from
    std::vector<std::uint32_t> indices;
    bool tangents = false;  // `attributes` have tangents
};

// Converts a primitive to triangles; points and lines give none. Without normals, every triangle gets
// vertices of its own. `material` determines whether missing tangents are generated.
Vertices make_vertices(const assets::Primitive& primitive, const assets::Material& material);

// Appends a copy of vertex `source` with another normal.
void copy_with_normal(Vertices& vertices, std::uint32_t source, const glm::vec3& normal);

// Returns the direction of increasing u at every vertex; w: handedness (glTF 2.0, 3.7.2.1: the bitangent is
// the cross product of normal and tangent, times w).
std::vector<glm::vec4> make_tangents(const assets::Primitive& primitive, std::size_t texcoord_set);

shared::Material make_material(const assets::Material& material);
// Returns the SCENE_… bits that the material needs.
std::uint32_t features_of(const assets::Material& material);
MaterialMaps maps_of(const assets::Material& material);

// Uploads all textures of the model, with mips if the texture uses them. Colours are sRGB, other maps are
// linear values.
Result<std::vector<GpuTexture>> upload_textures(gpu::Device& device, const assets::Model& model);

// Creates a texture of one texel.
Result<GpuTexture> plain_texture(gpu::Device& device, const std::array<std::uint8_t, 4>& texel);

}  // namespace bolt::render
