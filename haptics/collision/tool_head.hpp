// The heads of tools that grip a hexagon from its end: the ring, the socket and the hexagon key. Together
// with the open jaw (jaw.hpp) they are the heads that a tool can have: their fit on the part that they turn,
// in closed form, and their contacts with it.
//
// Frame of the tool: origin on the bolt's axis in the middle of the part that grips, +X along the handle, +Z
// along the bolt away from the members; only an open jaw may be turned over. Frame of the turned part, nut or
// screw head: as in jaw.hpp. A corner of the hexagon, or of the hexagonal socket, lies along its +X.
#pragma once

#include <array>
#include <span>
#include <variant>
#include <vector>

#include "haptics/collision/jaw.hpp"

namespace bolt::collision {

// The head of a ring wrench, or a socket. The hole is one hexagon, or the union of two that are 30° apart. It
// has 6 or 12 notches, called points, which receive the corners of the turned hexagon; one point lies along
// the tool's +X.
struct Ring {
    double opening = 0.0;  // m, across the flats of the hole
    int points = 12;       // 6 or 12
    double low = 0.0;      // m, lower and upper end of the flats along Z, with their chamfers
    double high = 0.0;
    double lead_in = 0.0;       // m, legs of the 45° chamfers at the open ends
    double outside = 0.0;       // m, diameter
    bool closed_above = false;  // a socket: a shoulder at `high` stops the nut
    double tooth_angle = 0.0;   // rad between two teeth of the ratchet; 0: no ratchet
};

// The tip of a hexagon key or bit.
struct HexKey {
    double width = 0.0;        // m, across the flats; a corner is at 30° from the tool's +X
    double tip = 0.0;          // m, height of the key's end along Z; negative
    double chamfer = 0.0;      // m, legs of the 45° chamfer at the end
    double length = 0.0;       // m of straight hexagon from the end
    double tooth_angle = 0.0;  // rad between two teeth of the ratchet; 0: no ratchet
};

using ToolHead = std::variant<Jaw, Ring, HexKey>;

// The hexagonal socket of a screw head.
struct HexagonSocket {
    double across_flats = 0.0;   // m, of the socket, which is wider than the key
    double depth = 0.0;          // m
    double mouth = 0.0;          // m, height of the head above its bearing face
    double head_diameter = 0.0;  // m
};

using TurnedShape = std::variant<HexagonPrism, HexagonSocket>;

// Returns true if the head can turn the shape: a jaw or a ring turns a hexagon, a key turns a socket.
bool grips(const ToolHead& head, const TurnedShape& shape);

// m across the flats of the head, and of the shape.
double width_across_flats(const ToolHead& head);
double width_across_flats(const TurnedShape& shape);

// rad between two angles of the handle at which the head fits the same hexagon: the angle between two teeth
// with a ratchet, otherwise 30° for a ring with 12 points and 60° for all other heads.
double fitting_angle(const ToolHead& head);

// rad between two teeth of the ratchet; 0 without a ratchet.
double tooth_angle(const ToolHead& head);

// m, extent of the gripping region along the bolt: the thickness of a jaw or a ring, the engaged length of a
// key.
double thickness(const ToolHead& head);

// m, height of the head's origin above the bearing face when the head is on the shape: the flats overlap as
// far as possible, and a socket neither stands on the seat nor hangs above the nut.
double grip_height(const ToolHead& head, const TurnedShape& shape);

// The position of a head on a shape that the head can turn. `tool`: pose of the tool in the frame of the
// shape.
HeadFit head_fit(const ToolHead& head, const TurnedShape& shape, const Pose& tool);

// A head or a shape as convex solids in its own frame.
Result<std::vector<Convex>> head_solids(const ToolHead& head);
Result<std::vector<Convex>> shape_solids(const TurnedShape& shape);

// Returns true if a point of the tool's mesh lies inside one of the solids of the head, which then represent
// it: its contacts as a mesh can be left out. Both are in the tool's frame. The solids omit fillets and the
// outer parts of a broad head.
bool covered(std::span<const Convex> head, const Vec3& point);

// One query of the contacts between a head and a shape that the head can turn.
struct GripQuery {
    const ToolHead& head;
    const TurnedShape& shape;
    GripSolids solids;
    double band = 0.0;    // m, up to which contacts are found
    ObstacleId obstacle;  // is copied to the contacts
};

// Writes the contacts and returns their number. `tool` and `shape`: poses in the assembly. Distances are
// exact if a face or two edges are nearest, otherwise too small (convex.hpp).
//
// A jaw is always tested with solid_contacts(). So is a ring, a socket or a key until all six edges of the
// hexagon reach into the hole. From then on it is tested against one hexagonal hole (of a hole with 12
// points, the one of its two hexagons that fits), in closed form: the hexagon
// touches no wall if none of its edges is beyond a wall. Each wall gets two contacts with the edge of the
// hexagon that is nearest to it: at the lower and at the upper end of the part of that edge within the hole.
// Six more points test the shoulder of a socket or the floor under a key.
std::size_t grip_contacts(const GripQuery& query, const Pose& tool, const Pose& shape,
                          std::span<Contact, max_grip_contacts> out);

}  // namespace bolt::collision
