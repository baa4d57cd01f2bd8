#include "tools/author/pictures/joint_view.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::author {

namespace {

constexpr double tilts[] = {to_radians(40.0), to_radians(25.0), to_radians(58.0)};  // from the joint's axis
constexpr int sides = 24;
constexpr double filled = 0.94;  // of the picture
// Visible fractions that the preferred tilt, a view from above and one across the handle are worth.
constexpr double tilt_weight = 0.05, above_weight = 0.06, across_weight = 0.06;

double visible_share(const geometry::WrenchRooms& rooms, const geometry::WrenchRoom& room,
                     const std::vector<Vec3>& points, const Vec3& back) {
    constexpr double reach = 10.0;  // m
    const auto seen = std::count_if(points.begin(), points.end(), [&](const Vec3& point) {
        return !geometry::first_hit(rooms.everything, point, back, reach,
                                    [&](std::uint32_t part) { return room.parts.contains(part); });
    });
    return points.empty() ? 1.0 : static_cast<double>(seen) / static_cast<double>(points.size());
}

}  // namespace

view::Orbit joint_view(const geometry::WrenchRooms& rooms, const geometry::WrenchRoom& room,
                       const PictureContents& contents, double aspect) {
    const glm::dmat3 turn(room.to_assembly);
    const Vec3 handle = turn * Vec3(std::cos(room.handle), 0.0, -std::sin(room.handle));
    Vec3 best(0.0);
    double most = -1.0;
    for (const double tilt : tilts)
        for (int i = 0; i < sides; ++i) {
            const double side = 2.0 * pi * i / sides;
            const Vec3 back = glm::normalize(turn * Vec3(std::sin(tilt) * std::cos(side), std::cos(tilt),
                                                         std::sin(tilt) * std::sin(side)));
            const double worth = visible_share(rooms, room, contents.visible, back) -
                                 tilt_weight * std::abs(tilt - tilts[0]) / tilts[0] + above_weight * back.y -
                                 across_weight * std::abs(glm::dot(back, handle));
            if (worth <= most + 1e-9) continue;
            most = worth;
            best = back;
        }
    view::Viewpoint viewpoint;
    Vec3 low(1e9), high(-1e9);
    for (const Vec3& p : contents.framed) low = glm::min(low, p), high = glm::max(high, p);
    viewpoint.target = glm::vec3(0.5 * (low + high));
    viewpoint.eye = viewpoint.target + glm::vec3(best);
    viewpoint.fov = view::default_fov;
    view::Orbit orbit = view::orbit_of(viewpoint);
    // The camera's axes, as the orbit will have them.
    const Vec3 right{std::cos(orbit.yaw), 0.0, -std::sin(orbit.yaw)}, up = glm::cross(best, right);
    const auto span_of = [&](const Vec3& axis) {
        double least = 1e9, greatest = -1e9;
        for (const Vec3& p : contents.framed) {
            const double at = glm::dot(p - orbit.target, axis);
            least = std::min(least, at);
            greatest = std::max(greatest, at);
        }
        return 0.5 * (least + greatest);
    };
    const Vec3 shift = span_of(right) * right + span_of(up) * up;
    orbit.target += shift;
    const double half = filled * std::tan(0.5 * orbit.fov);
    orbit.distance = 1e-3;
    for (const Vec3& p : contents.framed) {
        const Vec3 d = p - orbit.target;
        const double needed =
            std::max(std::abs(glm::dot(d, up)) / half, std::abs(glm::dot(d, right)) / (half * aspect));
        orbit.distance = std::max(orbit.distance, needed + glm::dot(d, best));
    }
    return orbit;
}

}  // namespace bolt::author
