// A triangle mesh for contact, with pseudonormals, sharp edges and smooth normals. The sign of a distance
// follows from angle-weighted pseudonormals (Bærentzen and Aanæs, "Signed distance computation using the
// angle weighted pseudonormal", IEEE TVCG 11(3), 2005), which are correct for closed surfaces only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::collision {

// An edge is sharp in three cases: the angle between the normals of its faces exceeds `sampled_edge_angle`;
// the edge stands more than `edge_rise` above the smooth surface through its faces; the edge is open or
// forked (ContactMesh::open_edges, forked_edges).
struct SharpEdge {
    std::array<std::uint32_t, 2> vertices;
    std::uint32_t triangle;            // one of its faces
    float angle;                       // rad, between the normals of its faces
    std::array<glm::vec3, 2> normals;  // unit, of the two faces; equal if there is one face only
    std::array<glm::vec3, 2> inward;   // unit, in each face and away from the edge
    bool convex;                       // only convex edges can be touched by other edges
};

// A long edge between facets of a round face: it exceeds the permitted spacing of samples.
struct RoundEdge {
    std::array<std::uint32_t, 2> vertices;
    std::uint32_t triangle;  // one of its faces
    float spacing;           // m, largest spacing of samples along the edge (spacing_on_round())
};

struct ContactMesh {
    std::vector<glm::vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    // Pseudonormals; only those of faces have unit length. Edge i of a triangle runs from its vertex i to the
    // next.
    std::vector<glm::vec3> face_normals;
    std::vector<std::array<glm::vec3, 3>> edge_normals;
    std::vector<glm::vec3> vertex_normals;

    std::vector<SharpEdge> sharp_edges;
    std::vector<RoundEdge> round_edges;

    // By corner of each triangle: the unit normal of the round surface that the facets approximate. It is the
    // mean, weighted by angle and area, of the normals of those faces around the vertex that are connected
    // to this one across edges blunter than `crease_angle`.
    std::vector<std::array<glm::vec3, 3>> smooth_normals;
    // By triangle, one bit per Region (closest.hpp): set for corners at which a crease ends and for edges
    // that are creases, where no smooth surface is defined.
    std::vector<std::uint8_t> creased;

    // Defects of the input. Near open edges the sign of a distance is not reliable.
    std::size_t without_area = 0;  // triangles without area, which were dropped
    std::size_t open_edges = 0;    // edges of one triangle only, or of two that face opposite ways
    std::size_t forked_edges = 0;  // edges of more than two triangles

    [[nodiscard]] bool watertight() const { return open_edges == 0 && forked_edges == 0; }
};

inline constexpr double edge_rise = 30e-6;  // m; an edge that stands out further is sharp
// rad; edges sharper than this get sample points along them, because a round face may touch such an edge
// anywhere. Up to `crease_angle` they still belong to a round surface.
inline constexpr double sampled_edge_angle = 20.0 * pi / 180.0;
// rad; facets that meet at a smaller angle than this approximate a round surface.
inline constexpr double crease_angle = 30.0 * pi / 180.0;
// m; between neighbouring samples a round surface rises by at most this.
inline constexpr double round_rise = 60e-6;
// 1/m; a lower curvature adds no samples.
inline constexpr double min_curvature = 10.0;

// The largest spacing of samples (m) on a surface of this curvature (1/m).
inline double spacing_on_round(double curvature) { return std::sqrt(8.0 * round_rise / curvature); }

// Three indices per triangle, counterclockwise seen from outside. Vertices at the same position are merged.
// Fails if the number of indices is not a multiple of three, an index is out of range, a coordinate is not
// finite or beyond 1 km, or no triangle has an area.
Result<ContactMesh> make_contact_mesh(std::span<const glm::vec3> vertices,
                                      std::span<const std::uint32_t> indices);

// Returns the mesh transformed by `pose`.
ContactMesh transformed(ContactMesh mesh, const Pose& pose);

// Adds `mesh` to `whole` as a separate, unconnected part.
void append(ContactMesh& whole, const ContactMesh& mesh);

inline std::array<Vec3, 3> corners(const ContactMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    return {Vec3(mesh.vertices[t[0]]), Vec3(mesh.vertices[t[1]]), Vec3(mesh.vertices[t[2]])};
}

}  // namespace bolt::collision
