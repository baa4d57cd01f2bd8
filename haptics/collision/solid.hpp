// A contact mesh with its search structures, in its own frame. Embree collects candidates in float with a
// margin; results are computed in double. Queries do not allocate, and their results do not depend on the
// order in which Embree visits candidates.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "haptics/collision/mesh.hpp"

struct RTCSceneTy;

namespace bolt::collision {

struct SceneRelease {
    void operator()(RTCSceneTy* scene) const;
};
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneRelease>;

struct BoundingBox {
    Vec3 low{0.0}, high{0.0};  // m
};

// A convex sharp edge, copied from the mesh into one contiguous record.
struct Ridge {
    std::array<glm::vec3, 2> ends;     // m
    std::array<glm::vec3, 2> normals;  // unit, of the two faces
    std::array<glm::vec3, 2> inward;   // unit, in each of the two faces and away from the edge
    glm::vec3 along;                   // unit
    std::uint32_t sharp_edge;          // index in `ContactMesh::sharp_edges`
};

struct Solid {
    ContactMesh mesh;
    std::vector<std::array<glm::vec3, 3>> corners;  // by triangle, contiguous for the distance loop
    std::vector<std::uint32_t> part;                // by triangle: index of the part that it came from
    std::vector<Ridge> ridges;                      // in the order of `edge_scene`
    // Embree's scenes of the triangles and of the ridges. `edge_scene` is null if there are no ridges.
    SceneHandle scene, edge_scene;
    BoundingBox box;
    Vec3 middle{0.0};            // of the box
    double radius = 0.0;         // m, of the sphere about `middle` that contains all vertices
    double origin_radius = 0.0;  // m, of the sphere about the origin that contains all vertices
};

// Joins closed surfaces in the order given. Parts may touch but must not overlap: in an overlap the normal of
// the nearest surface does not point out of the solid. Fails if there are no triangles or more than 65535
// parts, or if Embree cannot build the scenes.
Result<Solid> make_solid(std::span<const ContactMesh> parts);

// The tangent plane at the closest point of a surface. As a constraint this plane keeps the query point on
// the outer side of the surface.
struct SeparatingPlane {
    double distance = 0.0;  // m, signed; negative: the point is inside
    Vec3 point{0.0};        // m, on the surface
    Vec3 normal{0.0};       // unit, outward
    std::uint32_t triangle = 0;
};

inline constexpr double infinite_distance = std::numeric_limits<double>::infinity();

struct PointQueryResult {
    double distance = infinite_distance;  // m, signed, to the nearest surface within the radius
    std::size_t planes = 0;               // number of planes written
    // m; up to this distance the planes in the output cover every surface. Equals the band if the output
    // had room for all planes.
    double complete_within = 0.0;
};

// m; a surface that rises at most this far above a plane gets no plane of its own.
inline constexpr double plane_tolerance = 20e-6;
inline constexpr std::size_t max_planes = 8;  // that a query of the narrow phase returns

// The signed distance of `point` to the surface within `radius` (may be infinite), and the separating planes
// within `band` ≤ radius, nearest first. A point further than `radius` from the surface counts as outside.
PointQueryResult query_point(const Solid& solid, const Vec3& point, double radius, double band,
                             std::span<SeparatingPlane> planes);

// True if a surface intersects the segment between two points.
bool occluded(const Solid& solid, const Vec3& from, const Vec3& to);

}  // namespace bolt::collision
