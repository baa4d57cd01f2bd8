// A contact mesh that can be asked, in its own frame: what of it is near a point, and what a line meets.
// Embree finds the candidates in float, with a margin; every answer is computed in double. Asking allocates
// nothing, and the answer does not depend on the order in which Embree comes along.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "haptics/contact/mesh.hpp"

struct RTCSceneTy;

namespace bolt::contact {

struct SceneRelease {
    void operator()(RTCSceneTy* scene) const;
};
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneRelease>;

struct Box {
    Vec3 low{0.0}, high{0.0};
};

// A convex sharp edge, with all that is asked of it in one place.
struct Ridge {
    std::array<glm::vec3, 2> ends;
    std::array<glm::vec3, 2> normals;  // as SharpEdge has them
    std::array<glm::vec3, 2> inward;
    glm::vec3 along;           // unit
    std::uint32_t sharp_edge;  // its index in the mesh
};

struct Solid {
    ContactMesh mesh;
    // Of every triangle its corners, for it is read in one go.
    std::vector<std::array<glm::vec3, 3>> corners;
    // Of every triangle: which of the closed surfaces that it was joined from.
    std::vector<std::uint16_t> part;
    std::vector<Ridge> ridges;  // in the order of `edge_scene`
    SceneHandle scene, edge_scene;
    Box box;
    Vec3 middle{0.0};     // of the box
    double radius = 0.0;  // of the sphere about `middle` that holds all vertices
    double reach = 0.0;   // the same about the origin
};

// Parts are joined in their order; they may touch, but not overlap: deep in one, the surface of another that
// is inside too would be the nearest.
Result<Solid> make_solid(std::span<const ContactMesh> parts);

// A side of a solid near a point: a plane that keeps the point out.
struct Side {
    double distance = 0.0;  // m, signed: below 0 the point is inside
    Vec3 point{0.0};        // on the surface
    Vec3 normal{0.0};       // unit, outward
    std::uint32_t triangle = 0;
};

inline constexpr double nothing_near = std::numeric_limits<double>::infinity();

struct Near {
    double distance = nothing_near;  // signed, of the nearest surface within the radius asked
    std::size_t sides = 0;           // written
    // No surface within the band is closer than this without being in one of the sides written; the band
    // itself when there was room for all.
    double complete = 0.0;
};

// What rises less than this above a side already written, within the band, gets no side of its own.
inline constexpr double side_tolerance = 20e-6;
inline constexpr std::size_t most_sides = 8;

// The surface within `radius` of `point` (infinite: wherever it is), and the sides within `band` <= radius,
// the nearest first. A point whose nearest surface is further than `radius` is told to be outside.
Near near_point(const Solid& solid, const Vec3& point, double radius, double band, std::span<Side> sides);

// Whether a surface lies between two points.
bool blocked(const Solid& solid, const Vec3& from, const Vec3& to);

}  // namespace bolt::contact
