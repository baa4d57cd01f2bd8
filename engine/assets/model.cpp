#include "engine/assets/model.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

namespace bolt::assets {

std::vector<std::uint32_t> triangle_indices(const Primitive& primitive) {
    std::vector<std::uint32_t> corners = primitive.indices;
    if (corners.empty()) {
        corners.resize(primitive.positions.size());
        std::iota(corners.begin(), corners.end(), 0U);
    }
    if (primitive.topology == Topology::triangles) {
        corners.resize(corners.size() - corners.size() % 3);
        return corners;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        // glTF 2.0, section 3.7.2.1: every second triangle of a strip has reversed winding.
        if (primitive.topology == Topology::triangle_strip)
            triangles.insert(triangles.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
        if (primitive.topology == Topology::triangle_fan)
            triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
    return triangles;
}

glm::mat4 local_transform(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale) {
    return glm::translate(glm::mat4(1.0F), translation) * glm::mat4_cast(rotation) *
           glm::scale(glm::mat4(1.0F), scale);
}

std::vector<glm::mat4> world_transforms(const Model& model) {
    std::vector<glm::mat4> local;
    for (const Node& node : model.nodes)
        local.push_back(local_transform(node.translation, node.rotation, node.scale));
    return world_transforms(model, local);
}

std::vector<glm::mat4> world_transforms(const Model& model, std::span<const glm::mat4> local) {
    std::vector<glm::mat4> world(local.begin(), local.end());
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const Node& node : model.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!is_child[i]) pending.push_back(i);
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        for (const int index : model.nodes[node].children) {
            const auto child = static_cast<std::size_t>(index);
            world[child] = world[node] * local[child];
            pending.push_back(child);
        }
    }
    return world;
}

}  // namespace bolt::assets
