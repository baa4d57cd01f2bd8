#include "content/displays/panel_fit.hpp"

#include <algorithm>
#include <cmath>

#include "content/displays/check_displays.hpp"
#include "content/displays/wall_geometry.hpp"

namespace bolt::content {

namespace {

constexpr double margin_share = 0.02;  // of the wall's width and height, which stays free at each side
constexpr double below_eyes = 0.03;    // rad, of the direction to the panel
constexpr int refinements = 4;         // place, distance and size depend on one another

struct RatedFit {
    PanelFit fit;
    double rating = 0.0;  // the larger the better
};

// Where the head looks at the wall's plane, in the wall's coordinates; the point nearest to the eye if it
// looks elsewhere.
glm::dvec2 gaze_on(const WallAxes& axes, const Pose& head) {
    const Vec3 right = head.orientation * Vec3(1.0, 0.0, 0.0);
    const Vec3 ahead = glm::normalize(Vec3(right.z, -below_eyes, -right.x));
    const double towards = -glm::dot(axes.normal, ahead), distance = distance_in_front(axes, head.position);
    Vec3 seen = head.position - axes.origin;
    if (towards > 0.1) seen += distance / towards * ahead;
    return {glm::dot(seen, axes.right), glm::dot(seen, axes.up)};
}

RatedFit fit_on(const WallAxes& axes, const Pose& head) {
    const glm::dvec2 wall(axes.width, axes.height), margin = margin_share * wall;
    const glm::dvec2 points(panel_width_points, panel_height_points), gaze = gaze_on(axes, head);
    RatedFit rated;
    PanelFit& fit = rated.fit;
    glm::dvec2 at = glm::clamp(gaze, glm::dvec2(0.0), wall);
    double distance = 0.0;
    Vec3 centre(0.0);
    for (int i = 0; i < refinements; ++i) {
        distance = glm::distance(in_room(axes, at.x, at.y), head.position);
        const glm::dvec2 most = (wall - 2.0 * margin) / points;
        fit.point_size = std::min({1e-3 * comfortable_text * distance / panel_text_points, most.x, most.y});
        const glm::dvec2 half = 0.5 * fit.point_size * points;
        at = glm::clamp(gaze, margin + half, wall - margin - half);
        centre = in_room(axes, at.x, at.y);
    }
    distance = glm::distance(centre, head.position);
    fit.pose = {centre, glm::quat_cast(glm::dmat3(axes.right, axes.up, axes.normal))};
    const Vec3 view = (centre - head.position) / distance;
    const double upright = std::sqrt(std::max(0.0, 1.0 - std::pow(glm::dot(axes.up, view), 2.0)));
    fit.text_size = 1e3 * panel_text_points * fit.point_size * upright / distance;
    const double ahead = glm::dot(head.orientation * Vec3(0.0, 0.0, -1.0), view);
    rated.rating = std::min(fit.text_size, comfortable_text) * std::max(ahead, 0.05) *
                   -glm::dot(axes.normal, view) * (axes.up.y > 0.5 ? 1.0 : 0.5);
    return rated;
}

}  // namespace

std::optional<PanelFit> fit_panel(std::span<const Wall> walls, const Pose& head) {
    std::optional<RatedFit> best;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const WallAxes axes = axes_of(walls[i]);
        if (!(axes.width >= min_wall_edge && axes.height >= min_wall_edge) ||
            distance_in_front(axes, head.position) < min_viewer_distance)
            continue;
        RatedFit rated = fit_on(axes, head);
        rated.fit.wall = i;
        if (!best || rated.rating > best->rating) best = rated;
    }
    return best ? std::optional(best->fit) : std::nullopt;
}

}  // namespace bolt::content
