#include "tools/assets/sculpt/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::sculpt {

double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
    const Vec3 axis = b - a;
    const Vec3 from_a = p - a;
    const double length2 = glm::dot(axis, axis);
    const double taper = radius_a - radius_b;
    const double side2 = length2 - taper * taper;
    if (side2 <= 0.0) {  // one sphere contains the other
        return taper > 0.0 ? glm::length(from_a) - radius_a : glm::length(p - b) - radius_b;
    }
    const double along = glm::dot(from_a, axis);
    const double beyond = along - length2;
    const Vec3 across = from_a * length2 - axis * along;
    const double across2 = glm::dot(across, across);
    const double along2 = along * along * length2;
    const double beyond2 = beyond * beyond * length2;
    const double k = std::copysign(1.0, taper) * taper * taper * across2;
    if (std::copysign(1.0, beyond) * side2 * beyond2 > k) {
        return std::sqrt(across2 + beyond2) / length2 - radius_b;
    }
    if (std::copysign(1.0, along) * side2 * along2 < k) {
        return std::sqrt(across2 + along2) / length2 - radius_a;
    }
    return (std::sqrt(across2 * side2 / length2) + along * taper) / length2 - radius_a;
}

double ellipsoid(const Vec3& p, const Vec3& radii) {
    const double k0 = glm::length(p / radii);
    const double k1 = glm::length(p / (radii * radii));
    if (k1 < 1e-9) return -std::min({radii.x, radii.y, radii.z});
    return k0 * (k0 - 1.0) / k1;
}

double rounded_box(const Vec3& p, const Vec3& half, double radius) {
    const Vec3 q = glm::abs(p) - half + Vec3(radius);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
}

double smooth_union(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k * 0.25;
}

double smooth_intersection(double a, double b, double k) { return -smooth_union(-a, -b, k); }

double smooth_difference(double a, double b, double k) { return -smooth_union(-a, b, k); }

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Vec3 gradient(const SignedDistanceField& field, const Vec3& p, double h) {
    const Vec3 a(1, -1, -1);
    const Vec3 b(-1, -1, 1);
    const Vec3 c(-1, 1, -1);
    const Vec3 d(1, 1, 1);
    return (a * field(p + a * h) + b * field(p + b * h) + c * field(p + c * h) + d * field(p + d * h)) /
           (4.0 * h);
}

Vec3 project(const SignedDistanceField& field, Vec3 p, double h, int steps) {
    for (int i = 0; i < steps; ++i) {
        const Vec3 g = gradient(field, p, h);
        const double g2 = glm::dot(g, g);
        if (g2 < 1e-6) break;
        p -= g * (field(p) / g2);
    }
    return p;
}

namespace {

constexpr std::size_t block_size = 8;  // samples along the edge of a block

struct Grid {
    Vec3 low;
    double cell = 0.0;
    std::array<std::size_t, 3> size{};  // in samples
    std::vector<float> values;

    [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
        return (z * size[1] + y) * size[0] + x;
    }
    [[nodiscard]] Vec3 position(std::size_t x, std::size_t y, std::size_t z) const {
        return low + cell * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    }
};

void fill_block(const SignedDistanceField& field, Grid& grid, const std::array<std::size_t, 3>& start) {
    const double half = 0.5 * static_cast<double>(block_size) * grid.cell;
    const double centre = field(grid.position(start[0], start[1], start[2]) + Vec3(half - 0.5 * grid.cell));
    const bool near = std::abs(centre) < 2.0 * std::sqrt(3.0) * half;
    for (std::size_t z = start[2]; z < start[2] + block_size; ++z) {
        for (std::size_t y = start[1]; y < start[1] + block_size; ++y) {
            for (std::size_t x = start[0]; x < start[0] + block_size; ++x) {
                const double value = near ? field(grid.position(x, y, z)) : centre;
                grid.values[grid.index(x, y, z)] = static_cast<float>(value);
            }
        }
    }
}

Grid sample_field(const SignedDistanceField& field, const FieldBounds& box, double cell) {
    Grid grid;
    grid.low = box.low;
    grid.cell = cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double cells =
            std::ceil((box.high[axis] - box.low[axis]) / (cell * static_cast<double>(block_size)));
        grid.size[static_cast<std::size_t>(axis)] = (static_cast<std::size_t>(cells) + 1) * block_size;
    }
    grid.values.resize(grid.size[0] * grid.size[1] * grid.size[2]);
    for (std::size_t z = 0; z < grid.size[2]; z += block_size) {
        for (std::size_t y = 0; y < grid.size[1]; y += block_size) {
            for (std::size_t x = 0; x < grid.size[0]; x += block_size) fill_block(field, grid, {x, y, z});
        }
    }
    return grid;
}

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Computes the mean of the crossings on the twelve edges of a cell. Returns false if the surface does not
// cross the cell.
bool crossing_point(const Grid& grid, std::size_t x, std::size_t y, std::size_t z, Vec3& point) {
    std::array<double, 8> corner{};
    int inside = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        corner[i] = static_cast<double>(
            grid.values[grid.index(x + (i & 1U), y + ((i >> 1U) & 1U), z + ((i >> 2U) & 1U))]);
        inside += corner[i] < 0.0 ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return false;
    Vec3 sum(0.0);
    double count = 0.0;
    for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t bit = 1; bit < 8; bit <<= 1U) {
            const std::size_t b = a | bit;
            if (b == a || (corner[a] < 0.0) == (corner[b] < 0.0)) continue;
            const double t = corner[a] / (corner[a] - corner[b]);
            Vec3 p(static_cast<double>(a & 1U), static_cast<double>((a >> 1U) & 1U),
                   static_cast<double>((a >> 2U) & 1U));
            p[bit == 1 ? 0 : (bit == 2 ? 1 : 2)] += t;
            sum += p;
            count += 1.0;
        }
    }
    point = grid.position(x, y, z) + grid.cell * (sum / count);
    return true;
}

void add_quad(TriMesh& mesh, std::array<std::uint32_t, 4> quad, bool flip) {
    if (flip) std::swap(quad[1], quad[3]);
    const auto distance2 = [&](std::size_t i, std::size_t j) {
        const Vec3 d = mesh.positions[quad[i]] - mesh.positions[quad[j]];
        return glm::dot(d, d);
    };
    if (distance2(0, 2) <= distance2(1, 3)) {
        mesh.triangles.push_back({quad[0], quad[1], quad[2]});
        mesh.triangles.push_back({quad[0], quad[2], quad[3]});
    } else {
        mesh.triangles.push_back({quad[0], quad[1], quad[3]});
        mesh.triangles.push_back({quad[1], quad[2], quad[3]});
    }
}

// Builds the surface net: each grid edge that the surface crosses gives a quad of the vertices of the four
// cells around it.
TriMesh surface_nets(const Grid& grid) {
    TriMesh mesh;
    std::vector<std::uint32_t> vertex(grid.values.size(), none);
    for (std::size_t z = 0; z + 1 < grid.size[2]; ++z) {
        for (std::size_t y = 0; y + 1 < grid.size[1]; ++y) {
            for (std::size_t x = 0; x + 1 < grid.size[0]; ++x) {
                Vec3 point;
                if (!crossing_point(grid, x, y, z, point)) continue;
                vertex[grid.index(x, y, z)] = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.push_back(point);
            }
        }
    }
    const std::array<std::size_t, 3> step{1, grid.size[0], grid.size[0] * grid.size[1]};
    for (std::size_t z = 1; z + 1 < grid.size[2]; ++z) {
        for (std::size_t y = 1; y + 1 < grid.size[1]; ++y) {
            for (std::size_t x = 1; x + 1 < grid.size[0]; ++x) {
                const std::size_t here = grid.index(x, y, z);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const bool a = grid.values[here] < 0.0F;
                    const bool b = grid.values[here + step[axis]] < 0.0F;
                    if (a == b) continue;
                    const std::size_t u = step[(axis + 1) % 3];
                    const std::size_t v = step[(axis + 2) % 3];
                    add_quad(mesh, {vertex[here - u - v], vertex[here - v], vertex[here], vertex[here - u]},
                             b);
                }
            }
        }
    }
    return mesh;
}

}  // namespace

TriMesh extract(const SignedDistanceField& field, const FieldBounds& box, double cell, int relaxations) {
    TriMesh mesh = surface_nets(sample_field(field, box, cell));
    const double h = 0.1 * cell;
    for (int i = 0; i < relaxations; ++i) {
        relax_tangentially(mesh, 0.5);
        for (Vec3& p : mesh.positions) p = project(field, p, h, 1);
    }
    for (Vec3& p : mesh.positions) p = project(field, p, h, 2);
    return mesh;
}

}  // namespace bolt::sculpt
