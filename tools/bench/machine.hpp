// A generated, deterministic model of a machine, for benchmarks of renderers and loaders, ours and others'.
#pragma once

#include "engine/assets/model.hpp"

namespace bolt::bench {

struct MachineSize {
    int parts = 115;  // each has its own mesh, so that instancing is impossible
    int triangles = 121'000;
};

// Returns a model with size.parts parts and, up to rounding in each part, size.triangles triangles: housings,
// shafts, gears, flanges and hexagon bolts of paint, steel, brass and rubber, with normals, 1.2 m wide and
// half a metre high.
assets::Model make_machine(const MachineSize& size = {});

// The view of the benchmarks, with a vertical field of view of 35°. peer/run.mjs uses the same.
inline constexpr glm::vec3 machine_eye{1.1F, 1.0F, 1.3F}, machine_target{0.0F, 0.15F, 0.0F};

}  // namespace bolt::bench
