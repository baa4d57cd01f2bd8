// A surface that can be touched: triangles in float, with what tells inside from outside and what is sharp.
// Inside is told by angle-weighted pseudonormals (Bærentzen and Aanæs, "Signed distance computation using the
// angle weighted pseudonormal", IEEE TVCG 11(3), 2005), which are right for closed surfaces only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::collision {

// An edge that would be missed: the surface rises by more than `edge_rise` over what it would be without it.
// Also one that has not exactly two faces.
struct SharpEdge {
    std::array<std::uint32_t, 2> vertices;
    // One of its faces.
    std::uint32_t triangle;
    // Between the normals of its faces, rad.
    float angle;
    // Unit, of the two faces; equal where there is one face only.
    std::array<glm::vec3, 2> normals;
    // Unit, in each face and away from the edge.
    std::array<glm::vec3, 2> inward;
    // Sticks out. Only such edges can be touched by other edges.
    bool convex;
};

// An edge of a finely cut round face that is longer than its vertices may be apart.
struct RoundEdge {
    std::array<std::uint32_t, 2> vertices;
    std::uint32_t triangle;
    float spacing;  // m, see `spacing_on_round`
};

struct ContactMesh {
    std::vector<glm::vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    // Pseudonormals; only the faces' have unit length. Edge i of a triangle goes from its vertex i to the
    // next.
    std::vector<glm::vec3> face_normals;
    std::vector<std::array<glm::vec3, 3>> edge_normals;
    std::vector<glm::vec3> vertex_normals;

    std::vector<SharpEdge> sharp_edges;
    std::vector<RoundEdge> round_edges;

    // Of each triangle's corners the unit normals of the round surface that the facets stand for: of the
    // faces that follow each other about the vertex across edges duller than `crease`, weighted by angle and
    // area.
    std::vector<std::array<glm::vec3, 3>> smooth_normals;
    // Where there is no such surface, by Region (closest.hpp): a bit each for corners that a crease ends at
    // and for edges that are one.
    std::vector<std::uint8_t> creased;

    // What was wrong with the triangles given. Where edges are open, the side of a point near them is a
    // guess.
    std::size_t without_area = 0;  // left out
    std::size_t open_edges = 0;    // of one triangle only, or of two that face opposite ways
    std::size_t forked_edges = 0;  // of more than two triangles

    [[nodiscard]] bool watertight() const { return open_edges == 0 && forked_edges == 0; }
};

inline constexpr double edge_rise = 30e-6;  // m
// Facets that meet more bluntly than this stand for a round surface.
inline constexpr double crease = 30.0 * pi / 180.0;
// Between neighbouring points a round surface rises by no more than this (m).
inline constexpr double round_rise = 60e-6;
// Surfaces that are less round (1/m) get no points for it.
inline constexpr double least_curvature = 10.0;

// How far apart (m) points may be on a surface of this curvature.
inline double spacing_on_round(double curvature) { return std::sqrt(8.0 * round_rise / curvature); }

// Three indices a triangle, counterclockwise seen from outside. Vertices in one place become one. An error:
// no triangle that has an area, an index out of range, a coordinate that is not finite or beyond 1 km.
Result<ContactMesh> make_contact_mesh(std::span<const glm::vec3> vertices,
                                      std::span<const std::uint32_t> indices);

// The same mesh somewhere else.
ContactMesh moved(ContactMesh mesh, const Pose& pose);

// `mesh` as a further, unconnected part of `whole`.
void append(ContactMesh& whole, const ContactMesh& mesh);

inline std::array<Vec3, 3> corners(const ContactMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    return {Vec3(mesh.vertices[t[0]]), Vec3(mesh.vertices[t[1]]), Vec3(mesh.vertices[t[2]])};
}

}  // namespace bolt::collision
