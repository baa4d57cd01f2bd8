// The obstacles of a servo, part by part, and their exact distance to and depth in the wrench.
#pragma once

#include <vector>

#include "haptics/collision/narrow_phase.hpp"
#include "tools/verify/oracle/contact_oracle.hpp"

namespace bolt::contact_validation {

using contact_oracle::DepthOptions;
using contact_oracle::Surface;

// The triangles of a contact mesh, for the oracle.
Surface surface_of(const collision::ContactMesh& mesh);

// A closed part of a body of the world.
struct Part {
    Surface surface;
    std::size_t body = 0;
    collision::ObstacleId id;  // of its obstacle
};

struct Scene {
    std::vector<Part> parts;
    Surface tool;
    geometry::Bvh tool_points;
    std::vector<geometry::Bvh> points;  // by body
};

Scene make_scene(const collision::World& world, const collision::ToolShape& tool);

struct Meeting {
    bool crosses = false;
    double gap = 0.0;         // m, where nothing crosses; `reach` where there is none smaller
    double depth = 0.0;       // m, of the deepest point of either in the other
    std::size_t deepest = 0;  // in which part, or which part in the tool
};

struct Looking {
    double reach = 0.0;  // m, of gaps
    DepthOptions depths;
};

// Disabled bodies count, too.
Meeting meet(const Scene& scene, const collision::World& world, const Pose& tool, const Looking& looking);
Meeting meet(const Scene& scene, std::size_t part, const Pose& tool_to_part, const Looking& looking);

// The same of the points alone that the finder looks at, each in the surface of the other: no gap is smaller,
// no point deeper than what it should tell.
Meeting meet_points(const Scene& scene, const collision::World& world, const Pose& tool, bool crosses,
                    const Looking& looking);

}  // namespace bolt::contact_validation
