#include "tools/assets/sculpt/environment.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "tools/assets/sculpt/field.hpp"

namespace bolt::sculpt {
namespace {

constexpr Vec3 eye(0.0, 0.20, 0.15);
constexpr Vec3 sky(0.72, 0.86, 1.0);
constexpr Vec3 lamp(1.0, 0.74, 0.46);

// An area light: a rectangle with uniform radiance.
struct LightPanel {
    Vec3 centre, half_u, half_v, normal;
    Vec3 radiance;
};

// The two strip lights, the windows and the lit wall.
const std::array<LightPanel, 4>& panels() {
    static const std::array<LightPanel, 4> all = [] {
        std::array<LightPanel, 4> out{};
        for (std::size_t i = 0; i < 2; ++i) {
            const room::StripLight& s = room::strip_lights[i];
            out[i] = {s.centre, Vec3(0.5 * s.length, 0, 0), Vec3(0, 0, 0.5 * s.width), Vec3(0, -1, 0),
                      s.colour * s.radiance};
        }
        out[2] = {Vec3(-room::side_wall, 1.15, 1.6), Vec3(0, 0, 1.9), Vec3(0, 0.62, 0), Vec3(1, 0, 0),
                  sky * 6.0};
        out[3] = {Vec3(room::side_wall, 0.85, 1.0), Vec3(0, 0, 0.55), Vec3(0, 0.85, 0), Vec3(-1, 0, 0),
                  lamp * 4.5};
        return out;
    }();
    return all;
}

// Returns the irradiance at a point, from a grid of points on each panel.
Vec3 irradiance(const Vec3& p, const Vec3& normal) {
    constexpr int n = 5;
    Vec3 sum(0.0);
    for (const LightPanel& panel : panels()) {
        const double area = 4.0 * glm::length(panel.half_u) * glm::length(panel.half_v) / (n * n);
        for (int i = 0; i < n * n; ++i) {
            const double u = (2.0 * (i % n) + 1.0) / n - 1.0;
            const double v = (2.0 * (i / n) + 1.0) / n - 1.0;
            const Vec3 to_light = panel.centre + panel.half_u * u + panel.half_v * v - p;
            const double d2 = glm::dot(to_light, to_light) + 0.01;
            const double from = -glm::dot(panel.normal, to_light);
            const double to = glm::dot(normal, to_light);
            if (from > 0.0 && to > 0.0) sum += panel.radiance * (area * from * to / (d2 * d2));
        }
    }
    return sum;
}

// Returns 1 inside the rectangle and 0 outside, with a transition of half width `soft` at its edge.
double rectangle_mask(double u, double v, double half_u, double half_v, double soft) {
    return smooth_step(half_u + soft, half_u - soft, std::abs(u)) *
           smooth_step(half_v + soft, half_v - soft, std::abs(v));
}

struct RoomHit {
    double distance = 1e9;
    Vec3 position{0.0}, normal{0.0};
};

// Intersects a ray from the eye with the walls, floor and ceiling.
RoomHit hit_walls(const Vec3& direction) {
    const Vec3 low(-room::side_wall, room::floor, room::back_wall);
    const Vec3 high(room::side_wall, room::ceiling, room::front_wall);
    RoomHit hit;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-9) continue;
        const double wall = direction[axis] > 0.0 ? high[axis] : low[axis];
        const double t = (wall - eye[axis]) / direction[axis];
        if (t >= hit.distance) continue;
        hit.distance = t;
        hit.normal = Vec3(0.0);
        hit.normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    }
    hit.position = eye + direction * hit.distance;
    return hit;
}

// Intersects a ray from the eye with the bench.
RoomHit hit_bench(const Vec3& direction) {
    RoomHit hit;
    if (direction.y > -1e-6) return hit;
    const double t = (-0.02 - eye.y) / direction.y;
    const Vec3 position = eye + direction * t;
    if (std::abs(position.x) > 0.95 || std::abs(position.z - 0.02) > 0.41) return hit;
    return {t, position, Vec3(0, 1, 0)};
}

// Returns the albedo of the floor, ceiling or wall.
Vec3 albedo(const RoomHit& hit) {
    const Vec3& p = hit.position;
    if (hit.normal.y > 0.5) return Vec3(0.12, 0.12, 0.13);   // floor
    if (hit.normal.y < -0.5) return Vec3(0.52, 0.52, 0.51);  // ceiling
    const Vec3 wall = hit.normal.z < -0.5 ? Vec3(0.16, 0.17, 0.19) : Vec3(0.46, 0.46, 0.44);
    const Vec3 below(0.13, 0.17, 0.18);
    return below + (wall - below) * smooth_step(room::dado - 0.01, room::dado + 0.01, p.y);
}

// Returns the radiance of the windows: panes between mullions, with the sky brighter below than above.
Vec3 window_radiance(const Vec3& p) {
    const LightPanel& panel = panels()[2];
    const double z = p.z - panel.centre.z;
    const double y = p.y - panel.centre.y;
    const double pane = std::abs(std::remainder(z, 0.76));
    const double glass = rectangle_mask(z, y, 1.9, 0.62, 0.02) * smooth_step(0.345, 0.325, pane) *
                         smooth_step(0.015, 0.035, std::abs(y - 0.2));
    return panel.radiance * (glass * (1.25 - 0.35 * (y + 0.62)));
}

Vec3 wall_radiance(const Vec3& p) {
    const LightPanel& panel = panels()[3];
    const double z = (p.z - panel.centre.z) / 0.55;
    const double y = (p.y - panel.centre.y) / 0.85;
    // A soft box is brightest in the middle.
    return panel.radiance * (rectangle_mask(z, y, 1.0, 1.0, 0.10) * (1.2 - 0.45 * (z * z + y * y)));
}

}  // namespace

Vec3 workshop_radiance(const Vec3& direction) {
    // The strip lights occlude the ceiling.
    for (std::size_t i = 0; i < room::strip_lights.size(); ++i) {
        if (direction.y < 1e-6) break;
        const room::StripLight& s = room::strip_lights[i];
        const Vec3 p = eye + direction * ((s.centre.y - eye.y) / direction.y);
        const double share =
            rectangle_mask(p.x - s.centre.x, p.z - s.centre.z, 0.5 * s.length, 0.5 * s.width, 0.02);
        if (share > 0.0) return s.colour * (s.radiance * share);
    }
    if (const RoomHit below = hit_bench(direction); below.distance < 1e8) {
        const bool plate = std::abs(below.position.x) < 0.5 && std::abs(below.position.z) < 0.31;
        const Vec3 colour = plate ? Vec3(0.24, 0.24, 0.235) : Vec3(0.34, 0.235, 0.145);
        return colour * (irradiance(below.position, below.normal) / pi + Vec3(0.25, 0.25, 0.26));
    }
    const RoomHit hit = hit_walls(direction);
    Vec3 light = albedo(hit) * (irradiance(hit.position, hit.normal) / pi + Vec3(0.22, 0.23, 0.25));
    if (hit.normal.x > 0.5) light += window_radiance(hit.position);
    if (hit.normal.x < -0.5) light += wall_radiance(hit.position);
    return light;
}

Panorama workshop_panorama(int width) {
    constexpr int subsamples = 3;
    Panorama out;
    out.width = width;
    out.height = width / 2;
    out.pixels.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int row = 0; row < out.height; ++row) {
        for (int column = 0; column < out.width; ++column) {
            Vec3 sum(0.0);
            for (int i = 0; i < subsamples * subsamples; ++i) {
                const double u = (column + (i % subsamples + 0.5) / subsamples) / out.width;
                const double v = (row + (i / subsamples + 0.5) / subsamples) / out.height;
                const double turn = (u - 0.5) * 2.0 * pi;
                const double down = v * pi;
                sum += workshop_radiance(
                    {std::sin(turn) * std::sin(down), std::cos(down), -std::cos(turn) * std::sin(down)});
            }
            out.pixels.emplace_back(sum / static_cast<double>(subsamples * subsamples));
        }
    }
    return out;
}

}  // namespace bolt::sculpt
