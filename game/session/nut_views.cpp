#include "game/session/nut_views.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::session {

namespace {

constexpr std::size_t spots = 400;       // sample points on the nut: within 5 %, enough to choose a view
constexpr double narrowest = 4.0 / 3.0;  // aspect ratio of a picture

bool in_picture(const content::View& view, const Vec3& point) {
    const Vec3 ahead = glm::normalize(view.target - view.eye);
    const Vec3 right = glm::normalize(glm::cross(ahead, Vec3(0.0, 1.0, 0.0)));
    const Vec3 to = point - view.eye;
    const double depth = glm::dot(to, ahead), half_height = depth * std::tan(0.5 * view.field_of_view);
    return depth > 0.0 && std::abs(glm::dot(to, right)) < narrowest * half_height &&
           std::abs(glm::dot(to, glm::cross(right, ahead))) < half_height;
}

}  // namespace

void seat_nuts(const servo::Setup& setup, servo::ToolContact& touch) {
    for (std::size_t i = 0; i < touch.nut_bodies.size(); ++i)
        if (touch.nut_bodies[i])
            touch.world.bodies[*touch.nut_bodies[i]].pose =
                servo::nut_pose(setup.nuts[i], setup.nuts[i].start_gap / setup.nuts[i].lead);
}

std::vector<NutView> views_of_nut(const content::Assembly& assembly, const servo::ToolContact& touch,
                                  std::size_t joint) {
    std::vector<NutView> all;
    if (joint >= touch.nut_bodies.size() || !touch.nut_bodies[joint]) return all;
    const std::size_t body = *touch.nut_bodies[joint];
    const std::vector<collision::SurfacePoint> on_nut =
        collision::sample_outer_surface(touch.world.shapes[touch.world.bodies[body].shape].solid, spots);
    for (const content::View& view : assembly.views) {
        const collision::Visibility seen = collision::visibility_of(touch.world, body, on_nut, view.eye);
        all.push_back({seen.share, seen.angle / square(2.0 * std::tan(0.5 * view.field_of_view)),
                       in_picture(view, touch.world.bodies[body].pose.position)});
    }
    return all;
}

std::optional<std::size_t> best_view(std::span<const NutView> views) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].framed && views[i].size > 0.0 && (!best || views[i].size > views[*best].size)) best = i;
    return best;
}

}  // namespace bolt::session
