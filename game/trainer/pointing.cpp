#include "game/trainer/pointing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::trainer {

namespace {

constexpr double pick_margin = 1.6;  // picking radius relative to a nut's apparent size
constexpr double min_reach = 14.0;   // px, for a distant nut

}  // namespace

std::optional<glm::dvec2> project(const Projection& projection, const Vec3& point) {
    const glm::dvec4 clip = glm::dmat4(projection.eye.clip_from_world) * glm::dvec4(point, 1.0);
    if (clip.w <= 1e-9) return std::nullopt;
    return glm::dvec2(0.5 * (clip.x / clip.w + 1.0), 0.5 * (clip.y / clip.w + 1.0)) * projection.size;
}

std::optional<std::size_t> nut_at(const Projection& projection, const glm::dvec2& pointer,
                                  const servo::Setup& setup, std::span<const Vec3> centres) {
    std::optional<std::size_t> found;
    double nearest = 1.0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        const auto at = project(projection, centres[i]);
        if (!at) continue;
        // Apparent size: the projection of a length across the line of sight.
        const Vec3 sight = centres[i] - Vec3(projection.eye.position);
        const Vec3 helper = std::abs(sight.y) < 0.9 * glm::length(sight) ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        const Vec3 across = glm::normalize(glm::cross(sight, helper));
        const auto beside = project(projection, centres[i] + 0.5 * setup.nuts[i].across_flats * across);
        if (!beside) continue;
        const double reach = std::max(pick_margin * glm::distance(*beside, *at), min_reach);
        const double off = glm::distance(pointer, *at) / reach;
        if (off >= nearest) continue;
        nearest = off;
        found = i;
    }
    return found;
}

std::optional<double> pixels_to_segment(const Projection& projection, const glm::dvec2& pointer,
                                        const Vec3& from, const Vec3& to) {
    const auto a = project(projection, from), b = project(projection, to);
    if (!a || !b) return std::nullopt;
    const glm::dvec2 segment = *b - *a;
    const double length = glm::dot(segment, segment);
    const double along = length > 0.0 ? std::clamp(glm::dot(pointer - *a, segment) / length, 0.0, 1.0) : 0.0;
    return glm::distance(pointer, *a + along * segment);
}

glm::dvec2 lever_on_screen(const Projection& projection, const Pose& tool, const Vec3& axis,
                           double handle_length) {
    constexpr double step = 1e-3;  // rad
    const Vec3 arm = handle_length * (tool.orientation * Vec3(1, 0, 0));
    const Quat turn = glm::angleAxis(-step, axis);
    const auto now = project(projection, tool.position + arm),
               then = project(projection, tool.position + turn * arm);
    if (!now || !then) return {min_lever, 0.0};
    const glm::dvec2 lever = (*then - *now) / step;
    const double length = glm::length(lever);
    if (length < 1e-6) return {min_lever, 0.0};
    return lever * (std::max(length, min_lever) / length);
}

double drag_angle(const glm::dvec2& lever, const glm::dvec2& drag) {
    return glm::dot(drag, lever) / glm::dot(lever, lever);
}

}  // namespace bolt::trainer
