// Converts a scene into draw calls: culled, sorted for drawing, and merged into instances.
#pragma once

#include <map>
#include <span>

#include "engine/render/scene.hpp"

namespace bolt::render {

// Determines the pipeline of a part. Shaders are specialized for exactly these features, because one shader
// with flags for all features took 1.5 times as long on lavapipe.
struct PipelineKind {
    bool blends = false;
    // Shaded while drawn: blended, or with properties that the geometry buffer cannot store.
    bool forward = false;
    bool ghost = false;  // blended, and only its nearest layer is visible
    bool double_sided = false;
    std::uint32_t features = 0;  // SCENE_… bits (shaders/shared.h)
    friend auto operator<=>(const PipelineKind&, const PipelineKind&) = default;
};

// The location of a part's deformed vertices, in the vertex order of the model.
struct DeformedPart {
    VkBuffer buffer = VK_NULL_HANDLE;            // null: the part is not deformed
    VkDeviceSize positions = 0, attributes = 0;  // offsets in bytes
    friend bool operator==(const DeformedPart&, const DeformedPart&) = default;
};
using DeformedParts = std::map<std::pair<const Deformation*, const MeshPart*>, DeformedPart>;

// One draw call: the instances of a part at one level of detail.
struct Draw {
    PipelineKind kind;
    const GpuModel* model = nullptr;
    std::uint32_t part = 0, level = 0;  // indices into GpuModel::parts and MeshPart::levels
    std::uint32_t material = 0;         // index into the list's materials
    bool outlined = false;
    std::uint32_t first_instance = 0, instances = 0;
    DeformedPart deformed;
};

// The geometry buffer stores the index of a material in 15 bits (shaders/surface.glsl). Renderer::render
// fails if the list has more materials.
inline constexpr std::size_t max_materials = 32768;

struct DrawList {
    std::vector<shared::Instance> instances;
    std::vector<shared::Material> materials;  // of all models
    std::vector<Draw> draws;                  // opaque parts, then blended ones from far to near
    std::uint32_t features = 0;               // SCENE_… bits that parts in the geometry buffer need
    std::vector<BoundingBox> forward;         // in world space, of parts that are shaded while drawn
    std::vector<BoundingBox> outlined;        // in world space, of outlined parts
    std::uint64_t triangles = 0;
};

// Limits for the error of levels of detail: the coarsest level within the limit is drawn.
struct DetailLimits {
    float height_px = 0.0F;   // height of the picture
    float allowed_px = 0.0F;  // largest error on the screen, for the nearest eye
    float allowed_m = 0.0F;   // largest error in the scene, used if there are no eyes (shadow map)
    float margin = 0.0F;      // RendererOptions::margin: distance beyond the picture's edges that is drawn
};

// Objects fade inside a cone from the eye to the cut-away's focus. Returns the box of the sphere at the
// cone's end; in the picture it covers the whole cone.
BoundingBox cone_end(const CutAway& cut);

// Returns the SCENE_… bits of the scene's lighting, which are the same for every part.
std::uint32_t features_of(const Scene& scene);

// Collects all parts that any of the eyes may see; without eyes, all parts (for the shadow map). Parts that
// are not in `deformed` are drawn undeformed.
DrawList make_draw_list(const Scene& scene, std::span<const Eye> eyes, const DetailLimits& detail,
                        const DeformedParts& deformed = {});

}  // namespace bolt::render
