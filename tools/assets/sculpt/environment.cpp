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

// A light in the room: a rectangle with an even radiance.
struct Panel {
    Vec3 centre, half_u, half_v, normal;
    Vec3 radiance;
};

// What hangs under the ceiling, the windows and the lit wall.
const std::array<Panel, 4>& panels() {
    static const std::array<Panel, 4> all = [] {
        std::array<Panel, 4> out{};
        for (std::size_t i = 0; i < 2; ++i) {
            const room::Strip& s = room::strips[i];
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

// Light on a wall, from a grid of points on each panel.
Vec3 irradiance(const Vec3& p, const Vec3& normal) {
    constexpr int n = 5;
    Vec3 sum(0.0);
    for (const Panel& panel : panels()) {
        const double area = 4.0 * glm::length(panel.half_u) * glm::length(panel.half_v) / (n * n);
        for (int i = 0; i < n * n; ++i) {
            const double u = (2.0 * (i % n) + 1.0) / n - 1.0;
            const double v = (2.0 * (i / n) + 1.0) / n - 1.0;
            const Vec3 way = panel.centre + panel.half_u * u + panel.half_v * v - p;
            const double d2 = glm::dot(way, way) + 0.01;
            const double from = -glm::dot(panel.normal, way);
            const double to = glm::dot(normal, way);
            if (from > 0.0 && to > 0.0) sum += panel.radiance * (area * from * to / (d2 * d2));
        }
    }
    return sum;
}

// 1 inside the rectangle, 0 outside, with an edge of the given softness.
double cover(double u, double v, double half_u, double half_v, double soft) {
    return smooth_step(half_u + soft, half_u - soft, std::abs(u)) *
           smooth_step(half_v + soft, half_v - soft, std::abs(v));
}

struct Hit {
    double distance = 1e9;
    Vec3 place{0.0}, normal{0.0};
};

Hit walls(const Vec3& direction) {
    const Vec3 low(-room::side_wall, room::floor, room::back_wall);
    const Vec3 high(room::side_wall, room::ceiling, room::front_wall);
    Hit hit;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-9) continue;
        const double wall = direction[axis] > 0.0 ? high[axis] : low[axis];
        const double t = (wall - eye[axis]) / direction[axis];
        if (t >= hit.distance) continue;
        hit.distance = t;
        hit.normal = Vec3(0.0);
        hit.normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    }
    hit.place = eye + direction * hit.distance;
    return hit;
}

// The bench under the hands.
Hit bench(const Vec3& direction) {
    Hit hit;
    if (direction.y > -1e-6) return hit;
    const double t = (-0.02 - eye.y) / direction.y;
    const Vec3 place = eye + direction * t;
    if (std::abs(place.x) > 0.95 || std::abs(place.z - 0.02) > 0.41) return hit;
    return {t, place, Vec3(0, 1, 0)};
}

Vec3 paint(const Hit& hit) {
    const Vec3& p = hit.place;
    if (hit.normal.y > 0.5) return Vec3(0.12, 0.12, 0.13);   // floor
    if (hit.normal.y < -0.5) return Vec3(0.52, 0.52, 0.51);  // ceiling
    const Vec3 wall = hit.normal.z < -0.5 ? Vec3(0.16, 0.17, 0.19) : Vec3(0.46, 0.46, 0.44);
    const Vec3 below(0.13, 0.17, 0.18);
    return below + (wall - below) * smooth_step(room::dado - 0.01, room::dado + 0.01, p.y);
}

// Panes between mullions, the sky brighter below than above.
Vec3 window(const Vec3& p) {
    const Panel& panel = panels()[2];
    const double z = p.z - panel.centre.z;
    const double y = p.y - panel.centre.y;
    const double pane = std::abs(std::remainder(z, 0.76));
    const double glass = cover(z, y, 1.9, 0.62, 0.02) * smooth_step(0.345, 0.325, pane) *
                         smooth_step(0.015, 0.035, std::abs(y - 0.2));
    return panel.radiance * (glass * (1.25 - 0.35 * (y + 0.62)));
}

Vec3 lit_wall(const Vec3& p) {
    const Panel& panel = panels()[3];
    const double z = (p.z - panel.centre.z) / 0.55;
    const double y = (p.y - panel.centre.y) / 0.85;
    // A soft box: brightest in the middle.
    return panel.radiance * (cover(z, y, 1.0, 1.0, 0.10) * (1.2 - 0.45 * (z * z + y * y)));
}

}  // namespace

Vec3 workshop_radiance(const Vec3& direction) {
    // The strips hang below the ceiling and hide what is above them.
    for (std::size_t i = 0; i < room::strips.size(); ++i) {
        if (direction.y < 1e-6) break;
        const room::Strip& s = room::strips[i];
        const Vec3 p = eye + direction * ((s.centre.y - eye.y) / direction.y);
        const double share = cover(p.x - s.centre.x, p.z - s.centre.z, 0.5 * s.length, 0.5 * s.width, 0.02);
        if (share > 0.0) return s.colour * (s.radiance * share);
    }
    if (const Hit below = bench(direction); below.distance < 1e8) {
        const bool plate = std::abs(below.place.x) < 0.5 && std::abs(below.place.z) < 0.31;
        const Vec3 colour = plate ? Vec3(0.24, 0.24, 0.235) : Vec3(0.34, 0.235, 0.145);
        return colour * (irradiance(below.place, below.normal) / pi + Vec3(0.25, 0.25, 0.26));
    }
    const Hit hit = walls(direction);
    Vec3 light = paint(hit) * (irradiance(hit.place, hit.normal) / pi + Vec3(0.22, 0.23, 0.25));
    if (hit.normal.x > 0.5) light += window(hit.place);
    if (hit.normal.x < -0.5) light += lit_wall(hit.place);
    return light;
}

Panorama workshop_panorama(int width) {
    constexpr int fine = 3;
    Panorama out;
    out.width = width;
    out.height = width / 2;
    out.pixels.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int row = 0; row < out.height; ++row) {
        for (int column = 0; column < out.width; ++column) {
            Vec3 sum(0.0);
            for (int i = 0; i < fine * fine; ++i) {
                const double u = (column + (i % fine + 0.5) / fine) / out.width;
                const double v = (row + (i / fine + 0.5) / fine) / out.height;
                const double turn = (u - 0.5) * 2.0 * pi;
                const double down = v * pi;
                sum += workshop_radiance(
                    {std::sin(turn) * std::sin(down), std::cos(down), -std::cos(turn) * std::sin(down)});
            }
            out.pixels.emplace_back(sum / static_cast<double>(fine * fine));
        }
    }
    return out;
}

}  // namespace bolt::sculpt
