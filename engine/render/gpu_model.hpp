// A model in GPU memory: all meshes in shared buffers, materials in the shader's layout, and textures.
#pragma once

#include <optional>

#include "engine/assets/model.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/deformation.hpp"
#include "shaders/shared.h"

namespace bolt::render {

// The triangles of a part at one level of detail.
struct LevelRange {
    std::uint32_t first_index = 0, index_count = 0;
    float error = 0.0F;  // m in the mesh's frame: largest distance from the finest level
};

// The unit of a draw call: a primitive of a mesh.
struct MeshPart {
    std::vector<LevelRange> levels;  // finest first, at least one
    std::int32_t first_vertex = 0;
    std::uint32_t material = 0;  // index into the model's materials
    bool colors = false;         // has vertex colours
    bool tangents = false;
    BoundingBox box;  // in the mesh's frame, m
    Deformable bends;
};

struct MeshRange {
    std::uint32_t first = 0, count = 0;  // parts
};

// The textures of a material's maps; -1: none. The order is that of shared::Material::uv.
struct MaterialMaps {
    std::array<int, 11> textures{-1, -1, -1, -1, -1, -1,
                                 -1, -1, -1, -1, -1};  // index into the model's textures
    bool blends = false, double_sided = false;
};

struct GpuTexture {
    gpu::Image image;
    gpu::Sampler sampler;
};

struct GpuModel {
    gpu::Buffer positions;   // vec3 float
    gpu::Buffer attributes;  // VertexAttributes
    gpu::Buffer second_uv;   // vec2 float; only if a material uses it
    gpu::Buffer indices;     // uint32
    gpu::Buffer influences;  // only for parts with joints
    gpu::Buffer deltas;      // float, morph targets
    std::vector<MeshPart> parts;
    std::vector<MeshRange> meshes;
    std::vector<shared::Material> materials;  // the default material is appended
    std::vector<std::uint32_t> features;      // SCENE_… bits, parallel to materials
    std::vector<MaterialMaps> maps;           // parallel to materials
    std::vector<GpuTexture> textures;
    std::uint64_t triangles = 0;
};

// The attributes of a vertex beside its position (12 bytes).
struct VertexAttributes {
    std::int16_t normal[4];   // snorm
    std::int16_t tangent[4];  // snorm; w: handedness; zero: no tangent
    float texcoord[2];
    std::uint8_t color[4];  // unorm
};
static_assert(sizeof(VertexAttributes) == 28);

struct UploadOptions {
    bool levels = false;  // generate coarser levels of detail for dense meshes
};

// Uploads the triangles of a model and decodes its images; other primitives are skipped. Missing normals
// become face normals.
Result<GpuModel> upload_model(gpu::Device& device, const assets::Model& model,
                              const UploadOptions& options = {});

}  // namespace bolt::render
