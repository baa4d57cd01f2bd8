#include "game/view/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "game/view/stereo.hpp"

namespace bolt::view {

namespace {

constexpr double notch = 0.88;   // of the distance is left after one
constexpr double glide = 0.070;  // s

struct Axes {
    Vec3 right, up, back;  // back: from the target to the eye
};

Axes axes(const Orbit& o) {
    const Vec3 right(std::cos(o.yaw), 0.0, -std::sin(o.yaw));
    const Vec3 back(std::sin(o.yaw) * std::cos(o.pitch), std::sin(o.pitch),
                    std::cos(o.yaw) * std::cos(o.pitch));
    return {right, glm::cross(back, right), back};
}

// Metres at the target's distance that a height of the picture spans.
double span(const Orbit& o) { return 2.0 * o.distance * std::tan(0.5 * o.fov); }

double extent(const render::BoundingBox& box) {
    return std::max(static_cast<double>(glm::distance(box.low, box.high)), 1e-6);
}

}  // namespace

Orbit orbit_of(const Viewpoint& view) {
    const Vec3 way = Vec3(view.eye) - Vec3(view.target);
    const double across = std::hypot(way.x, way.z);
    Orbit orbit;
    orbit.target = Vec3(view.target);
    orbit.distance = std::max(glm::length(way), 1e-9);
    // Straight from above there is no side that it is seen from: it is the one that render::look_at takes.
    orbit.yaw = across < 1e-4 * std::abs(way.y) ? 0.0 : std::atan2(way.x, way.z);
    orbit.pitch =
        across < 1e-4 * std::abs(way.y) ? std::copysign(0.5 * pi, way.y) : std::atan2(way.y, across);
    orbit.fov = static_cast<double>(view.fov > 0.0F ? view.fov : usual_fov);
    return orbit;
}

Viewpoint viewpoint_of(const Orbit& o) {
    return {"", glm::vec3(o.target + o.distance * axes(o).back), glm::vec3(o.target),
            static_cast<float>(o.fov)};
}

render::Eye eye_of(const Orbit& o, const render::BoundingBox& box, float aspect, float aside) {
    const Axes a = axes(o);
    const Vec3 beside = static_cast<double>(aside) * a.right;
    const Vec3 eye = o.target + o.distance * a.back + beside;
    // Columns; the rows are the axes.
    const glm::dmat4 turn(glm::dvec4(a.right.x, a.up.x, a.back.x, 0.0),
                          glm::dvec4(a.right.y, a.up.y, a.back.y, 0.0),
                          glm::dvec4(a.right.z, a.up.z, a.back.z, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::mat4 view(glm::translate(turn, -eye));
    const render::Perspective through =
        lens(box, glm::vec3(eye), glm::vec3(o.target + beside), static_cast<float>(o.fov), aspect);
    return {glm::vec3(eye),
            converging(aside, static_cast<float>(o.distance), through) * render::perspective(through) * view};
}

void turn(Orbit& o, glm::dvec2 by) {
    o.yaw -= pi * by.x;
    o.pitch = std::clamp(o.pitch - pi * by.y, -0.5 * pi, 0.5 * pi);
}

void pan(Orbit& o, glm::dvec2 by) {
    const Axes a = axes(o);
    o.target -= span(o) * (by.x * a.right + by.y * a.up);
}

void zoom(Orbit& o, double notches, glm::dvec2 at, const render::BoundingBox& box) {
    const double size = extent(box);
    const double to = std::clamp(o.distance * std::pow(notch, notches), 1e-3 * size, 30.0 * size);
    const Axes a = axes(o);
    const Vec3 point = o.target + span(o) * (at.x * a.right + at.y * a.up);
    o.target = point + (o.target - point) * (to / o.distance);
    o.distance = to;
}

Orbit from_at_most(const Orbit& orbit, double eye) {
    const double sine = std::clamp((eye - orbit.target.y) / orbit.distance, std::sin(to_radians(5.0)), 1.0);
    Orbit lower = orbit;
    lower.pitch = std::min(orbit.pitch, std::asin(sine));
    return lower;
}

Orbit framing(const Orbit& o, const render::BoundingBox& box, float aspect) {
    render::Perspective through;
    through.fov = static_cast<float>(o.fov);
    through.aspect = aspect;
    const glm::vec3 middle = 0.5F * (box.low + box.high);
    const glm::vec3 eye = render::framing_eye(box, glm::vec3(axes(o).back), through);
    Orbit all = o;
    all.target = Vec3(middle);
    all.distance = static_cast<double>(glm::distance(eye, middle));
    return all;
}

void Glide::go(const Orbit& to) {
    goal = to;
    goal.yaw = shown.yaw + wrap(to.yaw - shown.yaw, 2.0 * pi);
}

bool Glide::advance(double seconds) {
    const double size = std::max(shown.distance, goal.distance);
    const double left =
        std::max({glm::distance(shown.target, goal.target) / size, std::abs(shown.yaw - goal.yaw),
                  std::abs(shown.pitch - goal.pitch), std::abs(shown.distance - goal.distance) / size,
                  std::abs(shown.fov - goal.fov)});
    if (left == 0.0) return false;
    if (left < 2e-4) {  // less than a pixel
        shown = goal;
        return true;
    }
    const double part = 1.0 - std::exp(-std::max(seconds, 0.0) / glide);
    shown.target += part * (goal.target - shown.target);
    shown.yaw += part * (goal.yaw - shown.yaw);
    shown.pitch += part * (goal.pitch - shown.pitch);
    shown.distance += part * (goal.distance - shown.distance);
    shown.fov += part * (goal.fov - shown.fov);
    return true;
}

}  // namespace bolt::view
