// A machine made by a program, always the same: what renderers and loaders are measured with, ours and
// others'.
#pragma once

#include "engine/assets/model.hpp"

namespace bolt::bench {

struct MachineSize {
    int parts = 115;  // each a mesh of its own, so that nothing can be drawn by instancing
    int triangles = 121'000;
};

// As many parts as asked for and within a part's rounding as many triangles: housings, shafts, gears, flanges
// and hexagon bolts, of paint, steel, brass and rubber, with normals, spread over 1.2 m and half a metre
// high.
assets::Model make_machine(const MachineSize& size = {});

// From where it is looked at, with a vertical field of view of 35°: peer/run.mjs does the same.
inline constexpr glm::vec3 machine_eye{1.1F, 1.0F, 1.3F}, machine_target{0.0F, 0.15F, 0.0F};

}  // namespace bolt::bench
