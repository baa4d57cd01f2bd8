// The wrench and the obstacles of a servo as oracle surfaces, part by part, with their exact gap and
// penetration depth.
#pragma once

#include <vector>

#include "haptics/collision/narrow_phase.hpp"
#include "tools/verify/oracle/contact_oracle.hpp"

namespace bolt::contact_validation {

using contact_oracle::ClosedSurface;
using contact_oracle::DepthOptions;

ClosedSurface surface_of(const collision::ContactMesh& mesh);

// A closed part of a body of the world, in the body's frame.
struct ObstaclePart {
    ClosedSurface surface;
    std::size_t body = 0;
    collision::ObstacleId id;  // the obstacle to which it belongs
};

// Sample points are stored as degenerate triangles.
struct ContactScene {
    std::vector<ObstaclePart> parts;
    ClosedSurface tool;
    geometry::Bvh tool_points;          // sample points of the tool
    std::vector<geometry::Bvh> points;  // sample points of each body
};

ContactScene make_scene(const collision::CollisionWorld& world, const collision::ToolShape& tool);

// The exact contact between tool and obstacles.
struct ExactContact {
    bool crosses = false;
    double gap = 0.0;         // m, at most `reach`; 0 if the surfaces cross
    double depth = 0.0;       // m, of the deepest point of either in the other
    std::size_t deepest = 0;  // index of the part with that depth
};

struct OracleQuery {
    double reach = 0.0;  // m, largest gap that is measured
    DepthOptions depths;
};

// The first overload takes all parts, including those of disabled bodies; the second takes `part` alone.
ExactContact exact_contact(const ContactScene& scene, const collision::CollisionWorld& world,
                           const Pose& tool, const OracleQuery& query);
ExactContact exact_contact(const ContactScene& scene, std::size_t part, const Pose& tool_to_part,
                           const OracleQuery& query);

// The same with only the sample points of the tool against the obstacles' surfaces, and those of the
// obstacles against the tool's surface. `crosses`: the surfaces cross; then only the depth is measured,
// otherwise only the gap. A contact query is expected to report this gap or a smaller one, and this depth or
// a greater one.
ExactContact exact_contact_of_points(const ContactScene& scene, const collision::CollisionWorld& world,
                                     const Pose& tool, bool crosses, const OracleQuery& query);

}  // namespace bolt::contact_validation
