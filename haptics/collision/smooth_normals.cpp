#include "haptics/collision/narrow_phase.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "haptics/collision/closest.hpp"

namespace bolt::collision {
namespace {

// Share of a triangle's height; a sample nearer to an edge counts as on it.
constexpr double edge_tolerance = 1e-3;

// Local shape of one of the two surfaces at a contact, in the assembly's frame.
struct SurfacePatch {
    std::optional<Vec3> normal;  // unit, outward; none on a crease
    double bend = 0.0;  // 1 − cosine of the largest angle between the normals at the facet's corners
    Vec3 along{0.0};    // unit, direction of a crease edge; zero otherwise
};

Vec3 unit(const Vec3& v) { return v / glm::length(v); }

// Barycentric coordinates of a point in the triangle's plane.
Vec3 barycentric(const std::array<Vec3, 3>& t, const Vec3& p) {
    const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double square_area = glm::dot(normal, normal);
    const double b = glm::dot(glm::cross(p - t[0], t[2] - t[0]), normal) / square_area;
    const double c = glm::dot(glm::cross(t[1] - t[0], p - t[0]), normal) / square_area;
    return {1.0 - b - c, b, c};
}

// `coordinates`: barycentric.
Region region_at(const Vec3& coordinates) {
    const bool at[3] = {coordinates.x < edge_tolerance, coordinates.y < edge_tolerance,
                        coordinates.z < edge_tolerance};
    for (Region i = 0; i < 3; ++i)
        if (at[(i + 1) % 3] && at[(i + 2) % 3]) return i;
    for (Region i = 0; i < 3; ++i)
        if (at[(i + 2) % 3]) return static_cast<Region>(3 + i);
    return 6;
}

SurfacePatch patch_on(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, Region region,
                      const Quat& turn) {
    const auto t = corners(mesh, triangle);
    const bool creased = region < 6 && (static_cast<unsigned>(mesh.creased[triangle]) >> region & 1U) != 0;
    SurfacePatch patch;
    if (creased) {
        if (region >= 3) patch.along = turn * unit(t[(region - 2U) % 3] - t[region - 3U]);
        return patch;
    }
    const auto& n = mesh.smooth_normals[triangle];
    const Vec3 coordinates = glm::clamp(barycentric(t, at), Vec3(0.0), Vec3(1.0));
    patch.normal =
        turn * unit(coordinates.x * Vec3(n[0]) + coordinates.y * Vec3(n[1]) + coordinates.z * Vec3(n[2]));
    for (std::size_t i = 0; i < 3; ++i)
        patch.bend = std::max(patch.bend, 1.0 - glm::dot(Vec3(n[i]), Vec3(n[(i + 1) % 3])));
    return patch;
}

// The patch nearest to a point of the other surface.
SurfacePatch nearest_patch(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& over,
                           const Quat& turn) {
    const ClosestTrianglePoint on = closest_on_triangle(over, corners(mesh, triangle));
    return patch_on(mesh, triangle, on.point, on.region, turn);
}

SurfacePatch sample_patch(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, const Quat& turn) {
    return patch_on(mesh, triangle, at, region_at(barycentric(corners(mesh, triangle), at)), turn);
}

// The patch of an edge sample: a crease, or the adjacent face if the edge is blunt.
SurfacePatch edge_patch(const ContactMesh& mesh, std::uint32_t triangle, const Vec3& at, const Vec3& along,
                        double angle, const Quat& turn) {
    if (angle > crease_angle) return {std::nullopt, 0.0, turn * along};
    return patch_on(mesh, triangle, at, 6, turn);
}

// The smooth surface's normal without its component along the crease: a crease cannot push along itself.
// Empty if little remains.
std::optional<Vec3> normal_across_crease(const Vec3& normal, const Vec3& along) {
    const Vec3 transverse = normal - glm::dot(normal, along) * along;
    const double length = glm::length(transverse);
    if (length < 0.5) return std::nullopt;
    return transverse / length;
}

// The smooth contact normal, from the obstacle to the tool; empty if neither surface defines one. The flatter
// surface has the greater weight.
std::optional<Vec3> combined_normal(const SurfacePatch& tool, const SurfacePatch& obstacle) {
    if (!tool.normal && !obstacle.normal) return std::nullopt;
    if (!tool.normal) return normal_across_crease(*obstacle.normal, tool.along);
    if (!obstacle.normal) return normal_across_crease(-*tool.normal, obstacle.along);
    const double bends = tool.bend + obstacle.bend;
    const double tool_weight = bends > 0.0 ? obstacle.bend / bends : 0.0;
    const Vec3 sum = (1.0 - tool_weight) * *obstacle.normal - tool_weight * *tool.normal;
    const double length = glm::length(sum);
    if (length < 0.5) return std::nullopt;
    return sum / length;
}

// Rotates `from` towards `to` by `share` of the angle between them, the angle being limited to
// max_smoothing_angle.
Vec3 rotated_towards(const Vec3& from, const Vec3& to, double share) {
    const Vec3 perpendicular = to - glm::dot(to, from) * from;
    const double sine = glm::length(perpendicular);
    if (sine < 1e-12) return from;
    const double angle = share * std::min(std::atan2(sine, glm::dot(to, from)), max_smoothing_angle);
    return std::cos(angle) * from + (std::sin(angle) / sine) * perpendicular;
}

double angle_of(const std::array<Vec3, 2>& inward) {
    return pi - std::acos(std::clamp(glm::dot(inward[0], inward[1]), -1.0, 1.0));
}

}  // namespace

void smooth_normals(const CollisionWorld& world, const ToolShape& tool, const Pose& pose,
                    std::span<Contact> contacts) {
    const Pose to_tool = inverse(pose);
    const ContactMesh& tool_mesh = tool.solid.mesh;
    for (Contact& c : contacts) {
        if (c.distance > smooth_far) continue;
        const Body& body = world.bodies[find_body(world, c.obstacle).value_or(0)];
        const CollisionShape& shape = world.shapes[body.shape];
        const ContactMesh& obstacle = shape.solid.mesh;
        const Pose to_body = inverse(body.pose);
        const Vec3 on_tool = to_tool * c.on_tool, on_obstacle = to_body * c.on_obstacle;
        const Quat& tool_orientation = pose.orientation;
        const Quat& body_orientation = body.pose.orientation;
        const bool is_tool_feature = (c.feature & of_obstacle) == 0;
        const std::uint32_t index = c.feature & ~of_obstacle;
        SurfacePatch tool_patch, obstacle_patch;
        if (!is_tool_feature) {
            const SurfaceSample& sample = shape.samples.samples[index];
            tool_patch = nearest_patch(tool_mesh, c.triangle, to_tool * c.on_obstacle, tool_orientation);
            obstacle_patch = sample_patch(obstacle, sample.triangle, on_obstacle, body_orientation);
        } else if (const SurfaceSample& sample = tool.samples.samples[index];
                   sample.piece == SurfaceSample::no_piece) {
            tool_patch = sample_patch(tool_mesh, sample.triangle, on_tool, tool_orientation);
            obstacle_patch = nearest_patch(obstacle, c.triangle, to_body * c.on_tool, body_orientation);
        } else {
            const PieceExtent& piece = tool.samples.pieces[sample.piece];
            tool_patch = edge_patch(tool_mesh, sample.triangle, on_tool, unit(piece.half),
                                    angle_of(piece.inward), tool_orientation);
            obstacle_patch = sample_patch(obstacle, c.triangle, on_obstacle, body_orientation);
        }
        const std::optional<Vec3> normal = combined_normal(tool_patch, obstacle_patch);
        if (!normal) continue;
        const double share = std::clamp((smooth_far - c.distance) / (smooth_far - smooth_near), 0.0, 1.0);
        c.smooth = rotated_towards(c.normal, *normal, share);
    }
}

}  // namespace bolt::collision
