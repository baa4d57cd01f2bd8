// A screw thread as a height field over the unrolled cylinder, and the rod that it bounds. The radius r(θ, z)
// is piecewise linear. Therefore the thread, its chamfered start and its run-out are plane polygons in (θ, z,
// r) with straight edges: the solid is exact and needs no sweep. Millimetres.
#pragma once

#include <TopoDS_Shape.hxx>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::models {

// r = r0 + r_theta θ + r_z z
struct FieldPlane {
    double r0 = 0.0, r_theta = 0.0, r_z = 0.0;
    [[nodiscard]] double at(double theta, double z) const { return r0 + r_theta * theta + r_z * z; }
};

// A right-handed thread with one start. A crest passes z = 0 at θ = 0.
struct ThreadField {
    double pitch = 0.0;
    double r_crest = 0.0;
    double r_root = 0.0;
    double crest_half_width = 0.0;  // along the axis
    double half_angle = 0.0;        // of the profile, rad
    double z0 = 0.0, z1 = 0.0;      // ends; r must not depend on θ there
    // Limits of r that do not depend on θ. Run-outs and countersinks are lower limits, chamfers are upper
    // limits.
    std::vector<FieldPlane> at_least, at_most;
};

struct FieldVertex {
    double theta = 0.0, z = 0.0, r = 0.0;
};

// A face of the field within one sector (half a turn) of the cylinder.
struct FieldFace {
    FieldPlane plane;
    int sector = 0;            // θ from sector·π to (sector + 1)·π
    std::vector<int> corners;  // vertex indices, counter-clockwise seen from outside
};

struct FieldMesh {
    std::vector<FieldVertex> vertices;  // θ in [0, 2π)
    // Adjacent faces share vertices. Each edge between the ends belongs to two faces.
    std::vector<FieldFace> faces;
};

// Returns the surface r(θ, z) between the ends as plane polygons.
FieldMesh thread_polygons(const ThreadField& field);

// Returns θ of a vertex within the range of a sector: sector 1 ends at 2π, not at 0.
double theta_in_sector(const FieldVertex& vertex, int sector);

// Returns the rod with radius r(θ, z) as a closed solid about the Z axis, from z0 to z1, with flat ends. Its
// faces are exact cylinders and cones and ruled flanks; adjacent faces share their edges. Fails if the solid
// is not valid.
Result<TopoDS_Shape> threaded_rod(const ThreadField& field);

}  // namespace bolt::models
