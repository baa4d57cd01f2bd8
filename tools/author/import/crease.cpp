#include "tools/author/import/crease.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "engine/base/math.hpp"

namespace bolt::step_import {

namespace {

// Vertices at one place have one number, whatever their normals were.
std::vector<std::uint32_t> places_of(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        return std::tuple(positions[i].x, positions[i].y, positions[i].z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> place(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        place[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? place[order[i - 1]] : order[i];
    return place;
}

}  // namespace

std::vector<glm::vec3> crease_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<std::uint32_t>& indices, double crease) {
    const std::vector<std::uint32_t> place = places_of(positions);
    std::vector<std::vector<std::uint32_t>> around(positions.size());  // triangles, by place
    std::vector<Vec3> area(indices.size() / 3), facing(indices.size() / 3);
    for (std::uint32_t t = 0; t < area.size(); ++t) {
        const auto p = [&](std::size_t k) { return Vec3(positions[indices[3 * t + k]]); };
        area[t] = glm::cross(p(1) - p(0), p(2) - p(0));
        const double length = glm::length(area[t]);
        if (length > 0.0) facing[t] = area[t] / length;
        for (std::size_t k = 0; k < 3; ++k) around[place[indices[3 * t + k]]].push_back(t);
    }
    const double least = std::cos(crease);
    std::vector<glm::vec3> normals(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        Vec3 sum{0.0};
        for (const std::uint32_t t : around[place[indices[i]]])
            if (glm::dot(facing[t], facing[i / 3]) > least) sum += area[t];
        const double length = glm::length(sum);
        normals[i] = length > 0.0 ? glm::vec3(sum / length) : glm::vec3(0.0F, 1.0F, 0.0F);
    }
    return normals;
}

}  // namespace bolt::step_import
