// A scene turned into draw calls: culled, sorted so that state changes little, and gathered into instances.
#pragma once

#include <span>

#include "engine/render/scene.hpp"

namespace bolt::render {

// Which pipeline draws it: what a part needs that others do not.
struct Kind {
    bool blends = false, double_sided = false, textured = false, colors = false;
    friend auto operator<=>(const Kind&, const Kind&) = default;
};

struct Draw {
    Kind kind;
    const GpuModel* model = nullptr;
    std::uint32_t part = 0;
    std::uint32_t first_instance = 0, instances = 0;
};

struct DrawList {
    std::vector<shared::Instance> instances;
    std::vector<shared::Material> materials;  // of all models
    std::vector<Draw> draws;                  // opaque by state, then what blends, far to near
    std::uint64_t triangles = 0;
};

// What any of the eyes may see. Without eyes: everything (for the shadow map).
DrawList make_draw_list(const Scene& scene, std::span<const Eye> eyes);

}  // namespace bolt::render
