#include "tools/author/geometry/scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace bolt::geometry {

namespace {

glm::dmat4 local_matrix(const assets::Node& node) {
    return glm::translate(glm::dmat4(1.0), Vec3(node.translation)) * glm::mat4_cast(Quat(node.rotation)) *
           glm::scale(glm::dmat4(1.0), Vec3(node.scale));
}

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Three indices a triangle, whatever the topology.
std::vector<std::uint32_t> corners(const assets::Primitive& primitive) {
    std::vector<std::uint32_t> list = primitive.indices, result;
    if (list.empty())
        for (std::uint32_t i = 0; i < primitive.positions.size(); ++i) list.push_back(i);
    switch (primitive.topology) {
        case assets::Topology::triangles:
            list.resize(list.size() / 3 * 3);
            return list;
        case assets::Topology::triangle_strip:
            for (std::size_t i = 2; i < list.size(); ++i) {
                const bool odd = i % 2 == 1;
                result.insert(result.end(), {list[odd ? i - 1 : i - 2], list[odd ? i - 2 : i - 1], list[i]});
            }
            return result;
        case assets::Topology::triangle_fan:
            for (std::size_t i = 2; i < list.size(); ++i)
                result.insert(result.end(), {list[0], list[i - 1], list[i]});
            return result;
        default:
            return {};
    }
}

void add_mesh(Part& part, const assets::Mesh& mesh, const glm::dmat4& world, std::uint32_t index) {
    for (const assets::Primitive& primitive : mesh.primitives) {
        std::vector<Vec3> points;
        points.reserve(primitive.positions.size());
        for (const glm::vec3& p : primitive.positions) points.emplace_back(world * glm::dvec4(Vec3(p), 1.0));
        const std::vector<std::uint32_t> list = corners(primitive);
        for (std::size_t i = 0; i + 2 < list.size(); i += 3) {
            if (list[i] >= points.size() || list[i + 1] >= points.size() || list[i + 2] >= points.size())
                continue;
            const Triangle t{points[list[i]], points[list[i + 1]], points[list[i + 2]], index};
            if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) continue;
            for (const Vec3& p : {t.a, t.b, t.c}) part.box.add(p);
            part.triangles.push_back(t);
        }
    }
}

}  // namespace

bool Scene::is_under(int node, int ancestor) const {
    while (node >= 0 && node != ancestor) node = nodes[static_cast<std::size_t>(node)].parent;
    return node >= 0;
}

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Part& part : parts) count += part.triangles.size();
    return count;
}

std::vector<std::string> Scene::names() const {
    std::vector<std::string> result;
    for (const auto& [name, found] : by_name) result.push_back(name);
    return result;
}

Scene flatten(const assets::Model& model) {
    Scene scene;
    struct Visit {
        int node, parent;
    };
    std::vector<Visit> stack;
    for (auto root = model.roots.rbegin(); root != model.roots.rend(); ++root) stack.push_back({*root, -1});
    std::vector<bool> seen(model.nodes.size(), false);  // a node has one parent at most
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        const auto index = static_cast<std::size_t>(visit.node);
        if (visit.node < 0 || index >= model.nodes.size() || seen[index]) continue;
        seen[index] = true;
        const assets::Node& node = model.nodes[index];
        const auto above = static_cast<std::size_t>(visit.parent);
        const int own = static_cast<int>(scene.nodes.size());
        const glm::dmat4 parent = visit.parent >= 0 ? scene.nodes[above].world : glm::dmat4(1.0);
        scene.nodes.push_back({node.name, visit.parent, parent * local_matrix(node)});
        if (!node.name.empty()) scene.by_name[node.name].push_back(own);
        if (node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model.meshes.size()) {
            Part part;
            part.node = own;
            for (int at = own; at >= 0 && part.name.empty();
                 at = scene.nodes[static_cast<std::size_t>(at)].parent)
                part.name = scene.nodes[static_cast<std::size_t>(at)].name;
            add_mesh(part, model.meshes[static_cast<std::size_t>(node.mesh)],
                     scene.nodes[static_cast<std::size_t>(own)].world,
                     static_cast<std::uint32_t>(scene.parts.size()));
            scene.parts.push_back(std::move(part));
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({*child, own});
    }
    return scene;
}

}  // namespace bolt::geometry
