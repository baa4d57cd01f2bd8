#include "haptics/collision/smooth_normals.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "haptics/collision/closest.hpp"

namespace bolt::collision {
namespace {

constexpr double at_border = 1e-3;  // of a triangle's height: a sample this near to an edge is on it

// What one of the two is like where they meet, in the assembly's frame.
struct Patch {
    std::optional<Vec3> normal;  // outward; none on a crease
    double bend = 0.0;           // how far it turns over the facet: 1 − cosine
    Vec3 along{0.0};             // of a crease its direction; zero at corners and elsewhere
};

Vec3 unit(const Vec3& v) { return v / glm::length(v); }

// The shares of the corners in a point of the triangle's plane.
Vec3 shares(const std::array<Vec3, 3>& t, const Vec3& p) {
    const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double whole = glm::dot(normal, normal);
    const double b = glm::dot(glm::cross(p - t[0], t[2] - t[0]), normal) / whole;
    const double c = glm::dot(glm::cross(t[1] - t[0], p - t[0]), normal) / whole;
    return {1.0 - b - c, b, c};
}

Region border(const Vec3& share) {
    const bool at[3] = {share.x < at_border, share.y < at_border, share.z < at_border};
    for (Region i = 0; i < 3; ++i)
        if (at[(i + 1) % 3] && at[(i + 2) % 3]) return i;
    for (Region i = 0; i < 3; ++i)
        if (at[(i + 2) % 3]) return static_cast<Region>(3 + i);
    return 6;
}

Patch patch_on(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, Region region,
               const Quat& turn) {
    const auto t = corners(mesh, triangle);
    const bool creased = region < 6 && (static_cast<unsigned>(mesh.creased[triangle]) >> region & 1U) != 0;
    Patch patch;
    if (creased) {
        if (region >= 3) patch.along = turn * unit(t[(region - 2U) % 3] - t[region - 3U]);
        return patch;
    }
    const auto& n = mesh.smooth_normals[triangle];
    const Vec3 share = glm::clamp(shares(t, at), Vec3(0.0), Vec3(1.0));
    patch.normal = turn * unit(share.x * Vec3(n[0]) + share.y * Vec3(n[1]) + share.z * Vec3(n[2]));
    for (std::size_t i = 0; i < 3; ++i)
        patch.bend = std::max(patch.bend, 1.0 - glm::dot(Vec3(n[i]), Vec3(n[(i + 1) % 3])));
    return patch;
}

// The surface that a point of the other's is over.
Patch surface(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& over, const Quat& turn) {
    const OnTriangle on = closest_on_triangle(over, corners(mesh, triangle));
    return patch_on(mesh, triangle, on.point, on.region, turn);
}

Patch of_sample(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, const Quat& turn) {
    return patch_on(mesh, triangle, at, border(shares(corners(mesh, triangle), at)), turn);
}

// An edge with the faces on its two sides.
Patch edge(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, const Vec3& along, double angle,
           const Quat& turn) {
    if (angle > crease) return {std::nullopt, 0.0, turn * along};
    return patch_on(mesh, triangle, at, 6, turn);
}

// The smooth one's normal as it is across a crease; the crease's own direction is none that it could push in.
std::optional<Vec3> across(const Vec3& normal, const Vec3& along) {
    const Vec3 left = normal - glm::dot(normal, along) * along;
    const double length = glm::length(left);
    if (length < 0.5) return std::nullopt;
    return left / length;
}

// From the obstacle to the tool.
std::optional<Vec3> joined(const Patch& tool, const Patch& obstacle) {
    if (!tool.normal && !obstacle.normal) return std::nullopt;
    if (!tool.normal) return across(*obstacle.normal, tool.along);
    if (!obstacle.normal) return across(-*tool.normal, obstacle.along);
    const double bends = tool.bend + obstacle.bend;
    const double of_tool = bends > 0.0 ? obstacle.bend / bends : 0.0;
    const Vec3 sum = (1.0 - of_tool) * *obstacle.normal - of_tool * *tool.normal;
    const double length = glm::length(sum);
    if (length < 0.5) return std::nullopt;
    return sum / length;
}

// As far from `from` to `to` as is allowed, times a share.
Vec3 turned(const Vec3& from, const Vec3& to, double share) {
    const Vec3 beside = to - glm::dot(to, from) * from;
    const double sine = glm::length(beside);
    if (sine < 1e-12) return from;
    const double angle = share * std::min(std::atan2(sine, glm::dot(to, from)), most_smoothed);
    return std::cos(angle) * from + (std::sin(angle) / sine) * beside;
}

double angle_of(const std::array<Vec3, 2>& inward) {
    return pi - std::acos(std::clamp(glm::dot(inward[0], inward[1]), -1.0, 1.0));
}

}  // namespace

void smooth_normals(const World& world, const ToolShape& tool, const Pose& pose,
                    std::span<Contact> contacts) {
    const Pose to_tool = inverse(pose);
    const ContactMesh& wrench = tool.solid.mesh;
    for (Contact& c : contacts) {
        if (c.distance > smooth_far) continue;
        const Body& body = world.bodies[find_body(world, c.obstacle).value_or(0)];
        const Shape& shape = world.shapes[body.shape];
        const ContactMesh& obstacle = shape.solid.mesh;
        const Pose to_body = inverse(body.pose);
        const Vec3 on_tool = to_tool * c.on_tool, on_obstacle = to_body * c.on_obstacle;
        const Quat& of_tool = pose.orientation;
        const Quat& of_body = body.pose.orientation;
        const bool seen_from_tool = (c.feature & of_obstacle) == 0;
        const std::uint32_t index = c.feature & ~of_obstacle;
        Patch here, there;
        if (!seen_from_tool) {
            const Sample& sample = shape.samples.samples[index];
            here = surface(wrench, c.triangle, to_tool * c.on_obstacle, of_tool);
            there = of_sample(obstacle, sample.triangle, on_obstacle, of_body);
        } else if (const Sample& sample = tool.samples.samples[index]; sample.piece == Sample::no_piece) {
            here = of_sample(wrench, sample.triangle, on_tool, of_tool);
            there = surface(obstacle, c.triangle, to_body * c.on_tool, of_body);
        } else {
            const Piece& piece = tool.samples.pieces[sample.piece];
            here = edge(wrench, sample.triangle, on_tool, unit(piece.half), angle_of(piece.inward), of_tool);
            there = of_sample(obstacle, c.triangle, on_obstacle, of_body);
        }
        const std::optional<Vec3> normal = joined(here, there);
        if (!normal) continue;
        const double share = std::clamp((smooth_far - c.distance) / (smooth_far - smooth_near), 0.0, 1.0);
        c.smooth = turned(c.normal, *normal, share);
    }
}

}  // namespace bolt::collision
