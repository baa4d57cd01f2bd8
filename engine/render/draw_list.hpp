// A scene turned into draw calls: culled, sorted so that state changes little, and gathered into instances.
#pragma once

#include <map>
#include <span>

#include "engine/render/scene.hpp"

namespace bolt::render {

// Which pipeline draws it: what a part needs that others do not. Shaders are compiled for just these
// features: one for all of them, with flags, took lavapipe half as long again.
struct Kind {
    bool blends = false;
    bool forward = false;  // lit as it is drawn: blends, or has more than the geometry buffer keeps
    bool ghost = false;    // blends, and hides what of it lies behind
    bool double_sided = false;
    std::uint32_t features = 0;  // SCENE_… bits
    friend auto operator<=>(const Kind&, const Kind&) = default;
};

// Where the deform pass has put a part's vertices, in the order that they have in the model.
struct DeformedPart {
    VkBuffer buffer = VK_NULL_HANDLE;  // null: the part is as its model has it
    VkDeviceSize positions = 0, attributes = 0;
    friend bool operator==(const DeformedPart&, const DeformedPart&) = default;
};
using DeformedParts = std::map<std::pair<const Deformation*, const Part*>, DeformedPart>;

struct Draw {
    Kind kind;
    const GpuModel* model = nullptr;
    std::uint32_t part = 0, level = 0;
    std::uint32_t material = 0;  // of the list
    bool outlined = false;
    std::uint32_t first_instance = 0, instances = 0;
    DeformedPart deformed;
};

struct DrawList {
    std::vector<shared::Instance> instances;
    std::vector<shared::Material> materials;  // of all models
    std::vector<Draw> draws;                  // opaque by state, then what blends, far to near
    std::uint32_t features = 0;               // SCENE_… bits that any part of the geometry buffer needs
    std::vector<Box> forward;                 // world: where something is lit as it is drawn
    std::vector<Box> outlined;                // world
    std::uint64_t triangles = 0;
};

// Which level of detail is drawn: the coarsest whose error stays below this.
struct Detail {
    float height_px = 0.0F;   // of the picture
    float allowed_px = 0.0F;  // as the nearest eye sees it
    float allowed_m = 0.0F;   // without eyes
};

// What fades does so in the cone around what is to be seen; of the cone the eye sees no more than its end.
Box end_of(const CutAway& cut);

// SCENE_… bits of the scene's light, the same for every part.
std::uint32_t features_of(const Scene& scene);

// What any of the eyes may see. Without eyes: everything (for the shadow map). `deformed`: what bends is
// there; what is not found is drawn as its model has it.
DrawList make_draw_list(const Scene& scene, std::span<const Eye> eyes, const Detail& detail,
                        const DeformedParts& deformed = {});

}  // namespace bolt::render
