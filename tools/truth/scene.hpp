// What the servo bumps into, part by part, and where it truly is against the wrench.
#pragma once

#include <vector>

#include "haptics/contact/proximity.hpp"
#include "tools/truth/surface.hpp"

namespace bolt::truth {

// A closed part of a body of the world.
struct Part {
    Surface surface;
    std::size_t body = 0;
    std::int32_t id = 0;  // of its obstacle
};

struct Scene {
    std::vector<Part> parts;
    Surface tool;
    geometry::Bvh tool_points;
    std::vector<geometry::Bvh> points;  // by body
};

Scene make_scene(const contact::World& world, const contact::ToolShape& tool);

struct Meeting {
    bool crosses = false;
    double gap = 0.0;         // m, where nothing crosses; `reach` where there is none smaller
    double depth = 0.0;       // m, of the deepest point of either in the other
    std::size_t deepest = 0;  // in which part, or which part in the tool
};

struct Looking {
    double reach = 0.0;  // m, of gaps
    Depths depths;
};

// Bodies that are off count too. `ignored`: the index of a body that does not.
Meeting meet(const Scene& scene, const contact::World& world, const Pose& tool, const Looking& looking);
Meeting meet(const Scene& scene, std::size_t part, const Pose& tool_to_part, const Looking& looking);

// The same of the points alone that the finder looks at, each in the surface of the other: no gap is smaller,
// no point deeper than what it should tell.
Meeting meet_points(const Scene& scene, const contact::World& world, const Pose& tool, bool crosses,
                    const Looking& looking);

}  // namespace bolt::truth
