#include "engine/assets/model.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

namespace bolt::assets {

namespace {

void set_subtree(const Model& model, int index, const glm::mat4& parent, std::vector<glm::mat4>& world) {
    const auto node = static_cast<std::size_t>(index);
    world[node] = parent * local_transform(model.nodes[node]);
    for (const int child : model.nodes[node].children) set_subtree(model, child, world[node], world);
}

}  // namespace

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

glm::mat4 local_transform(const Node& node) {
    return glm::translate(glm::mat4(1.0F), node.translation) * glm::mat4_cast(node.rotation) *
           glm::scale(glm::mat4(1.0F), node.scale);
}

std::vector<glm::mat4> world_transforms(const Model& model) {
    std::vector<glm::mat4> world(model.nodes.size(), glm::mat4(1.0F));
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const Node& node : model.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!is_child[i]) set_subtree(model, static_cast<int>(i), glm::mat4(1.0F), world);
    return world;
}

}  // namespace bolt::assets
