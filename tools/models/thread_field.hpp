// A screw thread as a height field over the unrolled cylinder: r(θ, z) is piecewise linear, so that the
// thread, its chamfered start and its run-out are plane polygons in (θ, z, r), cut at straight lines. Exact,
// no sweeping.
#pragma once

#include <vector>

namespace bolt::models {

// r = r0 + r_theta θ + r_z z
struct FieldPlane {
    double r0 = 0.0, r_theta = 0.0, r_z = 0.0;
    [[nodiscard]] double at(double theta, double z) const { return r0 + r_theta * theta + r_z * z; }
};

// Right-handed, one start. Millimetres. A crest passes z = 0 at θ = 0.
struct ThreadField {
    double pitch = 0.0;
    double r_crest = 0.0;
    double r_root = 0.0;
    double crest_half_width = 0.0;     // along the axis
    double half_angle = 0.0;           // of the profile, rad
    double z0 = 0.0, z1 = 0.0;         // ends; r does not depend on θ there
    std::vector<FieldPlane> at_least;  // run-out, countersinks: the field is never below these,
    std::vector<FieldPlane> at_most;   // chamfers: nor above these. Neither depends on θ.
};

struct FieldVertex {
    double theta = 0.0, z = 0.0, r = 0.0;
};

// A face of the field inside one sector (half a turn) of the cylinder.
struct FieldFace {
    FieldPlane plane;
    int sector = 0;            // θ from sector·π to (sector + 1)·π
    std::vector<int> corners;  // vertices, counter-clockwise seen from outside
};

struct FieldMesh {
    std::vector<FieldVertex> vertices;  // θ in [0, 2π)
    std::vector<FieldFace> faces;       // neighbours share vertices, every border is an edge of exactly two
};

FieldMesh polygons(const ThreadField& field);

// θ of a vertex as seen from a sector, where 2π is not 0.
double theta_in_sector(const FieldVertex& vertex, int sector);

}  // namespace bolt::models
