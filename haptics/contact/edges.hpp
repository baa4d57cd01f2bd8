// Edges against edges: where a straight piece of one solid's convex edge meets the convex edges of another.
#pragma once

#include "haptics/contact/solid.hpp"

namespace bolt::contact {

// A straight piece of a convex edge of another solid, in this solid's frame.
struct EdgePiece {
    Vec3 middle{0.0}, half{0.0};   // from middle - half to middle + half
    std::array<Vec3, 2> inward{};  // as SharpEdge has them
};

struct Crossing {
    double distance = 0.0;  // m, signed: below 0 the edges have passed through each other
    Vec3 on_piece{0.0}, on_edge{0.0};
    Vec3 normal{0.0};        // unit, away from the solid
    std::uint32_t edge = 0;  // of the solid's mesh.sharp_edges
};

// Edges that have passed each other are told up to here (m). Further in, points along them are.
inline constexpr double deepest_crossing = 2e-3;
// Of edges that have passed each other by more than this (m) one must really be in the other solid: past a
// thin rib there is nothing.
inline constexpr double surely_through = 0.1e-3;

struct Crossings {
    std::size_t count = 0;
    double complete = 0.0;  // as in Near
    // How long the piece need not be asked again: its points may move by `clear` less any band (m) as long as
    // it has turned by less than `turn` (rad) in all.
    double clear = 0.0, turn = 0.0;
};

// The edges of a solid that a piece can meet where it is, or near there. What is not listed is further than
// the radius that was asked for, or leads past it until it has turned by `turn` (rad).
struct FacingEdges {
    std::array<std::uint32_t, 40> ridges{};
    std::uint32_t count = 0;
    bool all = false;  // there was room
    double turn = 0.0;
};

// The convex edges within `band` of the piece, or passed by it, that face it, edge to edge; if there is no
// room for all, the nearest. `other`: the solid that the piece is of, `to_other` leads into its frame.
// What is further than `radius` need not be looked at. Fills `facing`.
Crossings near_edges(const Solid& solid, const EdgePiece& piece, const Solid& other, const Pose& to_other,
                     double radius, double band, std::span<Crossing> crossings, FacingEdges& facing);

// The same, of those that were all; `facing` with the radius and the turn that the piece's way since has
// left.
Crossings near_facing_edges(const Solid& solid, const EdgePiece& piece, const Solid& other,
                            const Pose& to_other, double radius, double band, std::span<Crossing> crossings,
                            const FacingEdges& facing);

}  // namespace bolt::contact
