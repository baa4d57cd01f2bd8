#include "tests/support/model_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/assets/gltf.hpp"

namespace bolt::test {

namespace {

struct Measures {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    double area = 0.0;  // m²
    double triangles = 0.0;
};

Measures measures_of(const assets::Mesh& mesh) {
    Measures m;
    for (const assets::Primitive& primitive : mesh.primitives) {
        for (const glm::vec3& p : primitive.positions) {
            m.low = glm::min(m.low, p);
            m.high = glm::max(m.high, p);
        }
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            const glm::vec3 a = primitive.positions[primitive.indices[i]];
            const glm::vec3 b = primitive.positions[primitive.indices[i + 1]];
            const glm::vec3 c = primitive.positions[primitive.indices[i + 2]];
            m.area += 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
            m.triangles += 1.0;
        }
    }
    return m;
}

bool is_near(double a, double b, double share) { return std::abs(a - b) <= share * std::max(a, b); }

std::string mesh_difference(const assets::Mesh& made, const assets::Mesh& kept) {
    const Measures a = measures_of(made), b = measures_of(kept);
    const float tolerance = std::max(1e-4F, 0.05F * glm::length(b.high - b.low));
    if (glm::length(a.low - b.low) > tolerance || glm::length(a.high - b.high) > tolerance)
        return "another box";
    if (!is_near(a.area, b.area, 0.10))
        return fmt::format("an area of {:.6f} m²; expected {:.6f} m² within 10 %", a.area, b.area);
    return "";
}

double triangles_of(const assets::Model& model) {
    double triangles = 0.0;
    for (const assets::Mesh& mesh : model.meshes) triangles += measures_of(mesh).triangles;
    return triangles;
}

}  // namespace

std::string model_difference(const std::filesystem::path& made, const std::filesystem::path& kept) {
    const Result<assets::Model> a = assets::read_gltf(made), b = assets::read_gltf(kept);
    if (!a) return a.error().message();
    if (!b) return b.error().message();
    if (a->nodes.size() != b->nodes.size())
        return fmt::format("{} nodes; expected {}", a->nodes.size(), b->nodes.size());
    for (std::size_t i = 0; i < a->nodes.size(); ++i) {
        const assets::Node &m = a->nodes[i], &k = b->nodes[i];
        if (m.name != k.name) return fmt::format("node \"{}\"; expected \"{}\"", m.name, k.name);
        if (glm::length(m.translation - k.translation) > 1e-5F || (m.mesh < 0) != (k.mesh < 0))
            return fmt::format("node \"{}\" has another place or no mesh", m.name);
        if (m.mesh < 0) continue;
        const std::string difference = mesh_difference(a->meshes[static_cast<std::size_t>(m.mesh)],
                                                       b->meshes[static_cast<std::size_t>(k.mesh)]);
        if (!difference.empty()) return fmt::format("node \"{}\" has {}", m.name, difference);
    }
    const double made_triangles = triangles_of(*a), kept_triangles = triangles_of(*b);
    if (!is_near(made_triangles, kept_triangles, 0.25))
        return fmt::format("{} triangles; expected {} within 25 %", made_triangles, kept_triangles);
    return "";
}

}  // namespace bolt::test
