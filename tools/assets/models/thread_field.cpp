#include "tools/assets/models/screw_thread.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/base/math.hpp"

namespace bolt::models {

namespace {

// Tolerance in rad and mm. Tabulated diameters are rounded, so vertices that should coincide differ by 1e-7.
constexpr double snap = 2e-6;

struct FieldPoint {
    double theta, z;
};
using FieldPolygon = std::vector<FieldPoint>;

// The part of a convex polygon where a θ + b z + c ≥ 0.
FieldPolygon clip(const FieldPolygon& polygon, double c, double a, double b) {
    FieldPolygon kept;
    const auto value = [&](const FieldPoint& p) { return a * p.theta + b * p.z + c; };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const FieldPoint& p = polygon[i];
        const FieldPoint& q = polygon[(i + 1) % polygon.size()];
        const double vp = value(p), vq = value(q);
        if (vp >= 0.0) kept.push_back(p);
        if ((vp > 0.0 && vq < 0.0) || (vp < 0.0 && vq > 0.0)) {
            const double t = vp / (vp - vq);
            kept.push_back({p.theta + t * (q.theta - p.theta), p.z + t * (q.z - p.z)});
        }
    }
    return kept;
}

// The part of a convex polygon where `upper` is not below `lower`.
FieldPolygon where_not_below(const FieldPolygon& polygon, const FieldPlane& upper, const FieldPlane& lower) {
    return clip(polygon, upper.r0 - lower.r0, upper.r_theta - lower.r_theta, upper.r_z - lower.r_z);
}

double area(const FieldPolygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const FieldPoint& p = polygon[i];
        const FieldPoint& q = polygon[(i + 1) % polygon.size()];
        twice += p.theta * q.z - q.theta * p.z;
    }
    return 0.5 * twice;
}

// Identifies the surface that a polygon lies on. Polygons of one surface and sector are joined.
using SurfaceKey = std::tuple<int, int, int>;  // sector, kind, turn

struct FieldMeshBuilder {
    FieldMesh mesh;
    std::map<SurfaceKey, FieldPlane> planes;
    std::map<SurfaceKey, std::vector<std::vector<int>>> loops;

    int vertex(const FieldPoint& p, const FieldPlane& plane) {
        double theta = p.theta;
        if (theta > 2.0 * pi - snap) theta = 0.0;
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
            if (std::abs(mesh.vertices[i].theta - theta) < snap && std::abs(mesh.vertices[i].z - p.z) < snap)
                return static_cast<int>(i);
        mesh.vertices.push_back({theta, p.z, plane.at(p.theta, p.z)});
        return static_cast<int>(mesh.vertices.size()) - 1;
    }

    void add(const SurfaceKey& key, const FieldPlane& plane, const FieldPolygon& polygon) {
        if (polygon.size() < 3 || area(polygon) < 1e-9) return;
        std::vector<int> loop;
        for (const FieldPoint& p : polygon) {
            const int v = vertex(p, plane);
            if (loop.empty() || loop.back() != v) loop.push_back(v);
        }
        while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
        if (loop.size() < 3) return;
        planes.emplace(key, plane);
        loops[key].push_back(std::move(loop));
    }

    // Returns the loop with every vertex that lies on one of its sides inserted as a corner, so that adjacent
    // polygons share it.
    [[nodiscard]] std::vector<int> with_all_corners(const std::vector<int>& loop, int sector) const {
        std::vector<int> full;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const int a = loop[i], b = loop[(i + 1) % loop.size()];
            full.push_back(a);
            const auto point = [&](int v) {
                const FieldVertex& vertex = mesh.vertices[static_cast<std::size_t>(v)];
                return FieldPoint{theta_in_sector(vertex, sector), vertex.z};
            };
            const FieldPoint p = point(a), q = point(b);
            const double dx = q.theta - p.theta, dz = q.z - p.z, length = std::hypot(dx, dz);
            std::vector<std::pair<double, int>> between;
            for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
                if (v == a || v == b) continue;
                const FieldPoint m = point(v);
                if (m.theta < sector * pi - snap || m.theta > (sector + 1) * pi + snap) continue;
                const double along = ((m.theta - p.theta) * dx + (m.z - p.z) * dz) / length;
                const double across = ((m.theta - p.theta) * dz - (m.z - p.z) * dx) / length;
                if (std::abs(across) < 2.0 * snap && along > 0.0 && along < length)
                    between.emplace_back(along, v);
            }
            std::sort(between.begin(), between.end());
            for (const auto& [along, v] : between) full.push_back(v);
        }
        return full;
    }

    // Joins the polygons of one surface: removes the sides that two of them share and chains the others to
    // outlines.
    void join(const SurfaceKey& key, const std::vector<std::vector<int>>& parts) {
        const int sector = std::get<0>(key);
        std::map<std::pair<int, int>, bool> sides;
        for (const std::vector<int>& part : parts) {
            const std::vector<int> loop = with_all_corners(part, sector);
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const int a = loop[i], b = loop[(i + 1) % loop.size()];
                if (const auto opposite = sides.find({b, a}); opposite != sides.end())
                    sides.erase(opposite);
                else
                    sides[{a, b}] = true;
            }
        }
        while (!sides.empty()) {
            FieldFace face;
            face.plane = planes.at(key);
            face.sector = sector;
            int v = sides.begin()->first.first;
            const int start = v;
            do {
                const auto side = sides.lower_bound({v, -1});
                if (side == sides.end() || side->first.first != v) break;
                face.corners.push_back(v);
                v = side->first.second;
                sides.erase(side);
            } while (v != start);
            mesh.faces.push_back(std::move(face));
        }
    }
};

enum Kind { crest = 0, falling = 1, root = 2, rising = 3, limit = 4 };

// One of the four strips of a thread's profile.
struct ProfileStrip {
    Kind kind;
    double from, to;  // range of u = z − P θ/2π − n P
    double r, slope;  // radius at u: r + slope (u − from)
};

}  // namespace

double theta_in_sector(const FieldVertex& vertex, int sector) {
    return sector == 1 && vertex.theta < snap ? 2.0 * pi : vertex.theta;
}

FieldMesh thread_polygons(const ThreadField& field) {
    const double P = field.pitch, w = field.crest_half_width;
    const double flank = (field.r_crest - field.r_root) * std::tan(field.half_angle);
    const double slope = 1.0 / std::tan(field.half_angle);
    const ProfileStrip strips[] = {{crest, -w, w, field.r_crest, 0.0},
                                   {falling, w, w + flank, field.r_crest, -slope},
                                   {root, w + flank, P - w - flank, field.r_root, 0.0},
                                   {rising, P - w - flank, P - w, field.r_root, slope}};
    FieldMeshBuilder builder;
    for (int sector = 0; sector < 2; ++sector) {
        const double from = sector * pi, to = (sector + 1) * pi;
        const int first = static_cast<int>(std::floor(field.z0 / P)) - 2;
        const int last = static_cast<int>(std::ceil(field.z1 / P)) + 2;
        for (int n = first; n <= last; ++n) {
            for (const ProfileStrip& strip : strips) {
                const double rise = P / (2.0 * pi);
                const auto z = [&](double theta, double u) { return u + rise * theta + n * P; };
                FieldPolygon cell = {{from, z(from, strip.from)},
                                     {to, z(to, strip.from)},
                                     {to, z(to, strip.to)},
                                     {from, z(from, strip.to)}};
                cell = clip(clip(cell, -field.z0, 0.0, 1.0), field.z1, 0.0, -1.0);
                if (cell.size() < 3) continue;
                const FieldPlane thread{strip.r - strip.slope * (strip.from + n * P), -strip.slope * rise,
                                        strip.slope};
                std::vector<FieldPlane> lower = {thread};
                lower.insert(lower.end(), field.at_least.begin(), field.at_least.end());
                for (std::size_t i = 0; i < lower.size(); ++i) {
                    FieldPolygon highest = cell;
                    for (std::size_t j = 0; j < lower.size(); ++j)
                        if (j != i) highest = where_not_below(highest, lower[i], lower[j]);
                    FieldPolygon below_limits = highest;
                    for (const FieldPlane& upper_limit : field.at_most)
                        below_limits = where_not_below(below_limits, upper_limit, lower[i]);
                    const int limit_kind = limit + static_cast<int>(i);
                    builder.add(
                        i == 0 ? SurfaceKey{sector, strip.kind, n} : SurfaceKey{sector, limit_kind, 0},
                        lower[i], below_limits);
                    for (std::size_t k = 0; k < field.at_most.size(); ++k) {
                        FieldPolygon cut = where_not_below(highest, lower[i], field.at_most[k]);
                        for (std::size_t j = 0; j < field.at_most.size(); ++j)
                            if (j != k) cut = where_not_below(cut, field.at_most[j], field.at_most[k]);
                        builder.add({sector, 100 + static_cast<int>(k), 0}, field.at_most[k], cut);
                    }
                }
            }
        }
    }
    for (const auto& [key, parts] : builder.loops) builder.join(key, parts);
    return std::move(builder.mesh);
}

}  // namespace bolt::models
