// A model as the GPU draws it: all meshes in three buffers, materials as the shader reads them, textures.
#pragma once

#include <optional>

#include "engine/assets/model.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/deformation.hpp"
#include "shaders/shared.h"

namespace bolt::render {

// Triangles of a part at one level of detail.
struct LevelRange {
    std::uint32_t first_index = 0, index_count = 0;
    float error = 0.0F;  // m in the mesh's frame: how far it may be from the finest
};

// What is drawn by one call: a primitive of a mesh.
struct Part {
    std::vector<LevelRange> levels;  // finest first, at least one
    std::int32_t first_vertex = 0;
    std::uint32_t material = 0;  // of the model
    bool colors = false;         // has colours at its vertices
    bool tangents = false;
    Box box;  // in the mesh's frame, m
    Deformable bends;
};

struct MeshRange {
    std::uint32_t first = 0, count = 0;  // parts
};

// Where a material's maps come from; −1: none. Order as in shared::Material::uv.
struct MaterialMaps {
    std::array<int, 11> textures{-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};  // of the model
    bool blends = false, double_sided = false;
};

struct GpuTexture {
    gpu::Image image;
    gpu::Sampler sampler;
};

struct GpuModel {
    gpu::Buffer positions;   // vec3 float
    gpu::Buffer attributes;  // VertexAttributes
    gpu::Buffer second_uv;   // vec2 float; only if a material looks at them
    gpu::Buffer indices;     // uint32
    gpu::Buffer influences;  // Influences, only of parts that have joints
    gpu::Buffer deltas;      // float, of morph targets
    std::vector<Part> parts;
    std::vector<MeshRange> meshes;
    std::vector<shared::Material> materials;  // one more than the model has: the default, last
    std::vector<std::uint32_t> features;      // SCENE_… bits, beside materials
    std::vector<MaterialMaps> maps;           // beside materials
    std::vector<GpuTexture> textures;
    std::uint64_t triangles = 0;
};

// 28 bytes beside a position of 12.
struct VertexAttributes {
    std::int16_t normal[4];   // snorm
    std::int16_t tangent[4];  // snorm; w: handedness; zero: none
    float texcoord[2];
    std::uint8_t color[4];  // unorm
};
static_assert(sizeof(VertexAttributes) == 28);

struct UploadOptions {
    bool levels = false;  // coarser levels of detail for what has many triangles
};

// Only triangles are drawn; missing normals become those of the faces. Decodes images.
Result<GpuModel> upload_model(gpu::Device& device, const assets::Model& model,
                              const UploadOptions& options = {});

}  // namespace bolt::render
