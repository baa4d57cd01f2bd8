// The hexagonal socket of a screw head, measured on its mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/author/geometry/joint_check.hpp"

namespace bolt::geometry {

namespace {

constexpr double socket_reach = 0.63;      // widths across flats; a corner is at 0.577
constexpr double least_play = -0.02 * mm;  // between the socket and its nominal width
constexpr double most_play = 0.3 * mm;
constexpr double depth_tolerance = 0.3 * mm;
constexpr double height_tolerance = 0.5 * mm;  // k max and k min differ by 0.36 mm for M8
constexpr double upright = 0.02;               // largest component along the axis of a wall's normal

struct Socket {
    MeasuredHexagon hexagon;
    double depth = 0.0;  // m, from the top of the head to the lowest end of a wall
};

// Measures the part of the head within the socket's corners; nullopt if it has no six walls.
std::optional<Socket> measure_socket(const Fastener& head, double across_flats) {
    std::vector<Triangle> inside;
    for (const Triangle& t : head.triangles)
        if (std::all_of(&t.a, &t.a + 3,
                        [&](const Vec3& p) { return std::hypot(p.x, p.z) < socket_reach * across_flats; }))
            inside.push_back(t);
    const auto hexagon = measure_hexagon(inside);
    if (!hexagon) return std::nullopt;
    Socket socket{*hexagon, 0.0};
    for (const Triangle& t : inside) {
        const Vec3 normal = normal_of(t);
        if (std::abs(normal.y) >= upright * glm::length(normal)) continue;
        for (const Vec3& p : {t.a, t.b, t.c}) socket.depth = std::max(socket.depth, head.box.high.y - p.y);
    }
    return socket;
}

}  // namespace

void check_socket(const JointCheck& s, const joint::TurnedPartSize& size) {
    const Fastener& head = s.parts.turned;
    const std::string name = content::in_quotes(head.name);
    const auto socket = measure_socket(head, size.across_flats);
    if (!socket) {
        s.error(fmt::format("{} has no hexagonal socket about the joint's axis", name),
                fmt::format("a socket of {:g} mm", size.across_flats / mm));
        return;
    }
    const double beside = std::hypot(socket->hexagon.centre.x, socket->hexagon.centre.z);
    if (beside > offset_tolerance)
        s.error(fmt::format("the socket of {} is {:.2g} mm beside the joint's axis", name, beside / mm),
                fmt::format("at most {:g} mm", offset_tolerance / mm));
    const double play = socket->hexagon.across_flats - size.across_flats;
    if (play < least_play || play > most_play || socket->hexagon.unevenness > most_play)
        s.error(fmt::format("the socket of {} measures {:.2f} mm across flats", name,
                            socket->hexagon.across_flats / mm),
                fmt::format("{:g} mm for {}", size.across_flats / mm, s.size().name));
    if (socket->depth < size.depth - depth_tolerance)
        s.error(fmt::format("the socket of {} is {:.2f} mm deep", name, socket->depth / mm),
                fmt::format("at least {:g} mm for {}", size.depth / mm, s.size().name));
    const double height = head.box.high.y - head.box.low.y;
    if (std::abs(height - size.height) > height_tolerance)
        s.error(fmt::format("the head of {} is {:.2f} mm high", name, height / mm),
                fmt::format("{:g} mm for {} (ISO 4762)", size.height / mm, s.size().name));
}

}  // namespace bolt::geometry
