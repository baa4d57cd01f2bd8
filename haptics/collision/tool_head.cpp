#include "haptics/collision/tool_head.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

namespace bolt::collision {
namespace {

constexpr double sixth = pi / 3.0, twelfth = pi / 6.0;
constexpr double key_corner = pi / 6.0;      // rad, of a corner of a key to the tool's +X
constexpr double shoulder_thickness = 3e-3;  // m of a socket's shoulder that is represented
constexpr double axis_clearance = 0.3e-3;    // m between a head on its shape and the seat or the floor

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

Vec3 direction(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

// m from the axis to a corner of a hexagon.
double corner_radius(double across_flats) { return across_flats / std::sqrt(3.0); }

void add_ends(double low, double high, std::vector<HalfSpace>& planes) {
    planes.push_back({{0, 0, 1}, high});
    planes.push_back({{0, 0, -1}, -low});
}

// Flats without their chamfers: the range along Z.
struct Range {
    double low = 0.0, high = 0.0;
};

Range flats_of(const Ring& ring) {
    return {ring.low + ring.lead_in, ring.closed_above ? ring.high : ring.high - ring.lead_in};
}

// A hole as one hexagon: walls at `apothem` (m) from the axis, a corner at `corner` (rad) from +X.
struct HexagonHole {
    double apothem = 0.0, corner = 0.0;
    Range flats;
};

// The six edges along a hexagonal prism.
struct HexagonEdges {
    double radius = 0.0, corner = 0.0;
    Range edges;
};

HexagonEdges edges_of(const HexagonPrism& prism) {
    const double drop = prism.corner_drop();
    return {corner_radius(prism.across_flats), 0.0, {drop, prism.height - drop}};
}

HexagonEdges edges_of(const HexKey& key) {
    return {corner_radius(key.width), key_corner, {key.tip + key.chamfer, key.tip + key.length}};
}

HexagonHole hole_of(const HexagonSocket& socket) {
    return {0.5 * socket.across_flats, 0.0, {socket.mouth - socket.depth, socket.mouth}};
}

// The part of an edge that is between the ends of the hole's flats, in the hole's frame.
struct Segment {
    Vec3 low{0.0}, high{0.0};
};
std::optional<Segment> edge_in_hole(const HexagonHole& hole, const HexagonEdges& prism, const Pose& to_hole,
                                    int edge) {
    const Vec3 side = prism.radius * direction(prism.corner + edge * sixth);
    const Vec3 from = to_hole * (side + Vec3(0, 0, prism.edges.low));
    const Vec3 to = to_hole * (side + Vec3(0, 0, prism.edges.high));
    const double rise = to.z - from.z;
    if (rise < 1e-9) return std::nullopt;  // turned over, or lying
    const double begin = std::max(0.0, (hole.flats.low - from.z) / rise);
    const double end = std::min(1.0, (hole.flats.high - from.z) / rise);
    if (end <= begin) return std::nullopt;
    return Segment{from + begin * (to - from), from + end * (to - from)};
}

HeadFit fit_in_hole(const HexagonHole& hole, const HexagonEdges& prism, const Pose& to_hole) {
    HeadFit fit;
    fit.toward_throat = fit.toward_mouth = 0.5 * prism.radius;
    fit.overlap = prism.edges.high - prism.edges.low;
    for (int edge = 0; edge < 6; ++edge) {
        const auto inside = edge_in_hole(hole, prism, to_hole, edge);
        fit.overlap = std::min(fit.overlap, inside ? glm::distance(inside->low, inside->high) : 0.0);
    }
    const Vec3 axis = to_hole.orientation * Vec3(0, 0, 1);
    fit.tilt = std::acos(std::clamp(axis.z, -1.0, 1.0));
    // The prism's axis where it passes the middle of the flats.
    const double middle = 0.5 * (hole.flats.low + hole.flats.high);
    const double along = std::abs(axis.z) > 0.5 ? (middle - to_hole.position.z) / axis.z : 0.0;
    const Vec3 at = to_hole.position + along * axis;
    fit.lateral_offset = std::hypot(at.x, at.y);
    return fit;
}

// rad about Z, −period/2 … period/2, by which the tool is turned off the nearest fitting angle.
double angle_off(const Pose& tool, double corner, double period) {
    const Vec3 x = tool.orientation * direction(corner);
    return wrap(std::atan2(x.y, x.x), period);
}

// A prism that is to fit a hole: a nut in a ring or socket, or a key in its socket.
struct PrismInHole {
    HexagonHole hole;
    HexagonEdges prism;
    double corner = 0.0;  // rad, of a corner of the head to the tool's +X
    double period = sixth;
    bool hole_in_tool = true;
};

PrismInHole prism_in_hole(const Ring& ring, const HexagonPrism& prism) {
    return {{0.5 * ring.opening, 0.0, flats_of(ring)},
            edges_of(prism),
            0.0,
            ring.points == 12 ? twelfth : sixth,
            true};
}

PrismInHole prism_in_hole(const HexKey& key, const HexagonSocket& socket) {
    return {hole_of(socket), edges_of(key), key_corner, sixth, false};
}

// The tool with its head turned in the ratchet so that it fits; without a ratchet as it is.
Pose with_fitting_head(const PrismInHole& pair, double tooth_angle, const Pose& tool) {
    if (tooth_angle <= 0.0) return tool;
    const double off = angle_off(tool, pair.corner, pair.period);
    return {tool.position, tool.orientation * glm::angleAxis(-off, Vec3(0, 0, 1))};
}

// A hole with 12 points is two hexagons. Chooses the one that is nearest to the nut.
void choose_hexagon(PrismInHole& pair, const Pose& tool) {
    if (pair.period == sixth) return;
    const double off = angle_off(tool, 0.0, sixth);
    if (std::abs(off) > 0.5 * twelfth) pair.hole.corner = twelfth;
}

HeadFit fit_of(PrismInHole pair, double tooth_angle, const Pose& given) {
    const Pose tool = with_fitting_head(pair, tooth_angle, given);
    choose_hexagon(pair, tool);
    HeadFit fit = fit_in_hole(pair.hole, pair.prism, pair.hole_in_tool ? inverse(tool) : tool);
    fit.misalignment = -angle_off(tool, pair.corner, pair.period);
    return fit;
}

// A contact between a point of the prism and a plane of the hole, in the hole's frame: a wall, the floor or
// the shoulder. `out`: unit normal of the plane, away from the prism.
struct HoleContact {
    Vec3 point{0.0}, out{0.0};
    double distance = 0.0;
    std::uint32_t feature = 0;
};

struct HoleContacts {
    std::array<HoleContact, max_grip_contacts> all;
    std::size_t count = 0;

    void add(const HoleContact& one, double band) {
        if (one.distance <= band && count < all.size()) all[count++] = one;
    }
};

// The nearest corner at each wall, at both ends of the edges.
void add_wall_contacts(const PrismInHole& pair, const Pose& to_hole, double band, HoleContacts& out) {
    std::array<HoleContact, 12> nearest;
    nearest.fill({{}, {}, 1e9, 0});
    for (int edge = 0; edge < 6; ++edge) {
        const auto inside = edge_in_hole(pair.hole, pair.prism, to_hole, edge);
        if (!inside) continue;
        for (const bool high : {false, true}) {
            const Vec3& point = high ? inside->high : inside->low;
            for (std::uint32_t wall = 0; wall < 6; ++wall) {
                const Vec3 normal = direction(pair.hole.corner + (wall + 0.5) * sixth);
                const double distance = pair.hole.apothem - glm::dot(normal, point);
                HoleContact& best = nearest[2 * wall + (high ? 1 : 0)];
                if (distance < best.distance) best = {point, normal, distance, 2 * wall + (high ? 1U : 0U)};
            }
        }
    }
    for (const HoleContact& one : nearest) out.add(one, band);
}

// Six points on a circle about the prism's axis, at `height` in its own frame, against the plane z = `floor`
// of the hole.
void add_floor_contacts(double radius, double height, double floor, const Vec3& out_of_hole,
                        const Pose& to_hole, double band, HoleContacts& out) {
    for (std::uint32_t k = 0; k < 6; ++k) {
        const Vec3 point = to_hole * (radius * direction(k * sixth) + Vec3(0, 0, height));
        out.add({point, out_of_hole, (floor - point.z) * out_of_hole.z, 12 + k}, band);
    }
}

std::size_t contacts_in_hole(const GripQuery& query, const PrismInHole& pair, const Pose& tool,
                             const Pose& shape, std::span<Contact, max_grip_contacts> out) {
    const Pose& hole_frame = pair.hole_in_tool ? tool : shape;
    const Pose to_hole = pair.hole_in_tool ? inverse(tool) * shape : inverse(shape) * tool;
    HoleContacts found;
    add_wall_contacts(pair, to_hole, query.band, found);
    if (const Ring* ring = std::get_if<Ring>(&query.head); ring != nullptr && ring->closed_above) {
        const auto& prism = std::get<HexagonPrism>(query.shape);
        add_floor_contacts(0.5 * prism.bearing, prism.height, ring->high, {0, 0, 1}, to_hole, query.band,
                           found);
    }
    if (const HexKey* key = std::get_if<HexKey>(&query.head))
        add_floor_contacts(corner_radius(key->width) - key->chamfer, key->tip, pair.hole.flats.low,
                           {0, 0, -1}, to_hole, query.band, found);
    for (std::size_t i = 0; i < found.count; ++i) {
        const HoleContact& one = found.all[i];
        const Vec3 point = hole_frame * one.point, outward = hole_frame.orientation * one.out;
        const Vec3 on_wall = point + one.distance * outward;
        Contact& c = out[i];
        c = {};
        c.on_tool = pair.hole_in_tool ? on_wall : point;
        c.on_obstacle = pair.hole_in_tool ? point : on_wall;
        c.normal = pair.hole_in_tool ? outward : -outward;
        c.distance = one.distance;
        c.obstacle = query.obstacle;
        c.feature = one.feature;
    }
    return found.count;
}

// The wall around a hole, which is divided into convex sectors.
struct WallShape {
    double apothem = 0.0, outside = 0.0;  // m; the outside as a diameter
    Range range;
    double lead_in_low = 0.0, lead_in_high = 0.0;
    int sectors = 6;
};

Result<std::vector<Convex>> wall_solids(const WallShape& wall) {
    std::vector<Convex> solids;
    const double width = 2.0 * pi / wall.sectors;
    for (int k = 0; k < wall.sectors; ++k) {
        const double from = k * width, to = from + width;
        std::vector<HalfSpace> planes{{direction(from - 0.5 * pi), 0.0},
                                      {direction(to + 0.5 * pi), 0.0},
                                      {direction(0.5 * (from + to)), 0.5 * wall.outside}};
        add_ends(wall.range.low, wall.range.high, planes);
        // In a hole with 12 points the flats of both hexagons meet in the middle of each sector.
        const std::array both{from + twelfth, to - twelfth};
        for (const double flank : std::span(both).first(wall.sectors == 12 ? 2 : 1)) {
            const Vec3 in = -direction(flank);
            planes.push_back({in, -wall.apothem});
            const double diagonal = std::sqrt(0.5);
            if (wall.lead_in_low > 0.0)
                planes.push_back({diagonal * (in - Vec3(0, 0, 1)),
                                  -diagonal * (wall.apothem + wall.range.low + wall.lead_in_low)});
            if (wall.lead_in_high > 0.0)
                planes.push_back({diagonal * (in + Vec3(0, 0, 1)),
                                  -diagonal * (wall.apothem - wall.range.high + wall.lead_in_high)});
        }
        BOLT_TRY_ASSIGN(auto solid, make_convex(planes));
        solids.push_back(std::move(solid));
    }
    return solids;
}

// A prism with 12 sides that represents a disc.
Result<Convex> disc(double diameter, double low, double high) {
    std::vector<HalfSpace> planes;
    add_ends(low, high, planes);
    for (int k = 0; k < 12; ++k) planes.push_back({direction(k * twelfth), 0.5 * diameter});
    return make_convex(planes);
}

Result<Convex> key_solid(const HexKey& key) {
    std::vector<HalfSpace> planes;
    add_ends(key.tip, key.tip + key.length, planes);
    const double diagonal = std::sqrt(0.5);
    for (int k = 0; k < 6; ++k) {
        const Vec3 out = direction(key_corner + (k + 0.5) * sixth);
        planes.push_back({out, 0.5 * key.width});
        planes.push_back(
            {diagonal * (out - Vec3(0, 0, 1)), diagonal * (0.5 * key.width - key.tip - key.chamfer)});
    }
    return make_convex(planes);
}

}  // namespace

bool grips(const ToolHead& head, const TurnedShape& shape) {
    return std::holds_alternative<HexKey>(head) == std::holds_alternative<HexagonSocket>(shape);
}

double width_across_flats(const ToolHead& head) {
    return std::visit(
        Overloaded{[](const Jaw& jaw) { return jaw.opening; }, [](const Ring& ring) { return ring.opening; },
                   [](const HexKey& key) { return key.width; }},
        head);
}

double width_across_flats(const TurnedShape& shape) {
    return std::visit([](const auto& any) { return any.across_flats; }, shape);
}

double tooth_angle(const ToolHead& head) {
    return std::visit(
        Overloaded{[](const Jaw&) { return 0.0; }, [](const auto& other) { return other.tooth_angle; }},
        head);
}

double fitting_angle(const ToolHead& head) {
    if (const double tooth = tooth_angle(head); tooth > 0.0) return tooth;
    const Ring* ring = std::get_if<Ring>(&head);
    return ring != nullptr && ring->points == 12 ? twelfth : sixth;
}

double thickness(const ToolHead& head) {
    return std::visit(Overloaded{[](const Jaw& jaw) { return jaw.thickness; },
                                 [](const Ring& ring) { return ring.high - ring.low; },
                                 [](const HexKey& key) { return -2.0 * key.tip; }},
                      head);
}

double grip_height(const ToolHead& head, const TurnedShape& shape) {
    if (const auto* socket = std::get_if<HexagonSocket>(&shape)) {
        const HexKey* key = std::get_if<HexKey>(&head);
        const double tip = key != nullptr ? key->tip : -0.5 * socket->depth;
        return socket->mouth - socket->depth - tip + axis_clearance;
    }
    const double height = std::get<HexagonPrism>(shape).height;
    const Ring* ring = std::get_if<Ring>(&head);
    if (ring == nullptr) return 0.5 * height;
    const double above_seat = axis_clearance - ring->low;
    const double below_shoulder = height - ring->high + axis_clearance;
    return std::max({ring->closed_above ? below_shoulder : 0.5 * height, above_seat});
}

HeadFit head_fit(const ToolHead& head, const TurnedShape& shape, const Pose& tool) {
    if (const auto* key = std::get_if<HexKey>(&head))
        return fit_of(prism_in_hole(*key, std::get<HexagonSocket>(shape)), key->tooth_angle, tool);
    const auto& prism = std::get<HexagonPrism>(shape);
    if (const auto* ring = std::get_if<Ring>(&head))
        return fit_of(prism_in_hole(*ring, prism), ring->tooth_angle, tool);
    return jaw_fit(std::get<Jaw>(head), prism, tool);
}

Result<std::vector<Convex>> head_solids(const ToolHead& head) {
    if (const Jaw* jaw = std::get_if<Jaw>(&head)) {
        BOLT_TRY_ASSIGN(auto parts, jaw_parts(*jaw));
        return std::vector<Convex>(parts.begin(), parts.end());
    }
    if (const HexKey* key = std::get_if<HexKey>(&head)) {
        BOLT_TRY_ASSIGN(auto solid, key_solid(*key));
        return std::vector<Convex>{std::move(solid)};
    }
    const Ring& ring = std::get<Ring>(head);
    WallShape wall{0.5 * ring.opening,
                   ring.outside,
                   {ring.low, ring.high},
                   ring.lead_in,
                   ring.closed_above ? 0.0 : ring.lead_in,
                   ring.points};
    BOLT_TRY_ASSIGN(auto solids, wall_solids(wall));
    if (ring.closed_above) {
        BOLT_TRY_ASSIGN(auto shoulder, disc(ring.outside, ring.high, ring.high + shoulder_thickness));
        solids.push_back(std::move(shoulder));
    }
    return solids;
}

Result<std::vector<Convex>> shape_solids(const TurnedShape& shape) {
    if (const auto* prism = std::get_if<HexagonPrism>(&shape)) {
        BOLT_TRY_ASSIGN(auto solid, hexagon(*prism));
        return std::vector<Convex>{std::move(solid)};
    }
    const auto& socket = std::get<HexagonSocket>(shape);
    const double floor = socket.mouth - socket.depth;
    WallShape wall{0.5 * socket.across_flats, socket.head_diameter, {floor, socket.mouth}, 0.0, 0.0, 6};
    BOLT_TRY_ASSIGN(auto solids, wall_solids(wall));
    BOLT_TRY_ASSIGN(auto bottom, disc(socket.head_diameter, 0.0, floor));
    solids.push_back(std::move(bottom));
    return solids;
}

bool covered(std::span<const Convex> head, const Vec3& point) {
    constexpr double facets = 20e-6;  // m by which a mesh may exceed the exact shape
    return std::any_of(head.begin(), head.end(), [&](const Convex& part) {
        return std::all_of(part.faces.begin(), part.faces.end(), [&](const ConvexFace& face) {
            return glm::dot(face.plane.normal, point) <= face.plane.offset + facets;
        });
    });
}

std::size_t grip_contacts(const GripQuery& query, const Pose& tool, const Pose& shape,
                          std::span<Contact, max_grip_contacts> out) {
    if (std::holds_alternative<Jaw>(query.head))
        return solid_contacts(query.solids, tool, shape, query.band, query.obstacle, out);
    const HexKey* key = std::get_if<HexKey>(&query.head);
    PrismInHole pair = key != nullptr
                           ? prism_in_hole(*key, std::get<HexagonSocket>(query.shape))
                           : prism_in_hole(std::get<Ring>(query.head), std::get<HexagonPrism>(query.shape));
    const Pose in_shape = with_fitting_head(pair, tooth_angle(query.head), inverse(shape) * tool);
    const Pose turned = shape * in_shape;
    choose_hexagon(pair, in_shape);
    const HeadFit fit = fit_in_hole(pair.hole, pair.prism, pair.hole_in_tool ? inverse(in_shape) : in_shape);
    if (fit.surrounds(width_across_flats(query.head)))
        return contacts_in_hole(query, pair, turned, shape, out);
    return solid_contacts(query.solids, turned, shape, query.band, query.obstacle, out);
}

}  // namespace bolt::collision
