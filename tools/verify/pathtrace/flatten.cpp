#include "tools/verify/pathtrace/flatten.hpp"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "engine/assets/model.hpp"
#include "engine/base/wildcard.hpp"

namespace bolt::pathtrace {

namespace {

using assets::Model;
using assets::Node;
using assets::Primitive;

bool any_matches(const std::string& name, const std::vector<std::string>& patterns) {
    for (const std::string& pattern : patterns)
        if (matches(pattern, name)) return true;
    return false;
}

struct Flattener {
    const Model& model;
    const NodeFilter& visibility;
    std::vector<glm::mat4> world;
    FlatMesh flat;

    void descend(int index, bool shown);
    void add(const Node& node, const glm::mat4& to_world);
    void add(const Primitive& primitive, const Node& node, glm::mat4 to_world,
             const std::vector<float>& weights);
    glm::mat4 skinned(const assets::Skin& skin, const Primitive& primitive, std::size_t vertex) const;
};

void Flattener::descend(int index, bool shown) {
    const Node& node = model.nodes[static_cast<std::size_t>(index)];
    if (any_matches(node.name, visibility.hide)) return;
    shown = shown || any_matches(node.name, visibility.show);
    if (shown) add(node, world[static_cast<std::size_t>(index)]);
    for (const int child : node.children) descend(child, shown);
}

void Flattener::add(const Node& node, const glm::mat4& to_world) {
    if (node.light >= 0)
        flat.lights.push_back({model.lights[static_cast<std::size_t>(node.light)], glm::vec3(to_world[3]),
                               -glm::normalize(glm::vec3(to_world[2]))});
    if (node.mesh < 0) return;
    const assets::Mesh& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
    const std::vector<float>& weights = node.weights.empty() ? mesh.weights : node.weights;
    for (const Primitive& primitive : mesh.primitives) add(primitive, node, to_world, weights);
}

glm::mat4 Flattener::skinned(const assets::Skin& skin, const Primitive& p, std::size_t vertex) const {
    glm::mat4 sum(0.0F);
    for (int i = 0; i < 4; ++i) {
        const float weight = p.weights[vertex][i];
        if (weight == 0.0F) continue;
        const std::size_t joint = p.joints[vertex][i];
        const glm::mat4 bind = skin.inverse_bind.empty() ? glm::mat4(1.0F) : skin.inverse_bind[joint];
        sum += weight * world[static_cast<std::size_t>(skin.joints[joint])] * bind;
    }
    return sum;
}

void Flattener::add(const Primitive& p, const Node& node, glm::mat4 to_world,
                    const std::vector<float>& weights) {
    const std::vector<std::uint32_t> corners = assets::triangle_indices(p);
    if (corners.empty()) return;
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    const assets::Skin* skin =
        node.skin >= 0 && !p.joints.empty() ? &model.skins[static_cast<std::size_t>(node.skin)] : nullptr;
    glm::mat3 normal_to_world = glm::transpose(glm::inverse(glm::mat3(to_world)));
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        glm::vec3 position = p.positions[i];
        glm::vec3 normal = p.normals.empty() ? glm::vec3(0.0F) : p.normals[i];
        for (std::size_t t = 0; t < p.targets.size() && t < weights.size(); ++t) {
            if (!p.targets[t].positions.empty()) position += weights[t] * p.targets[t].positions[i];
            if (!p.targets[t].normals.empty()) normal += weights[t] * p.targets[t].normals[i];
        }
        if (skin != nullptr) {
            to_world = skinned(*skin, p, i);
            normal_to_world = glm::transpose(glm::inverse(glm::mat3(to_world)));
        }
        Vertex vertex;
        vertex.position = glm::vec3(to_world * glm::vec4(position, 1.0F));
        normal = normal_to_world * normal;
        const float length = glm::length(normal);
        if (length > 0.0F) vertex.normal = normal / length;
        if (!p.tangents.empty())
            vertex.tangent = {glm::mat3(to_world) * glm::vec3(p.tangents[i]), p.tangents[i].w};
        for (std::size_t t = 0; t < 2; ++t)
            if (!p.texcoords[t].empty()) vertex.texcoords[t] = p.texcoords[t][i];
        if (!p.colors.empty()) vertex.color = p.colors[i];
        flat.vertices.push_back(vertex);
    }
    const auto material = static_cast<std::uint32_t>(p.material < 0 ? model.materials.size()
                                                                    : static_cast<std::size_t>(p.material));
    const bool mirrored = glm::determinant(glm::mat3(to_world)) < 0.0F;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        TracedTriangle triangle{{first + corners[i], first + corners[i + 1], first + corners[i + 2]},
                                material};
        if (mirrored) std::swap(triangle.corners[1], triangle.corners[2]);
        flat.triangles.push_back(triangle);
    }
}

}  // namespace

bool matches(std::string_view pattern, std::string_view name) {
    return matches_wildcard(pattern, name, [](char p, char n) { return p == '?' || p == n; });
}

FlatMesh flatten(const Model& model, const NodeFilter& visibility) {
    Flattener flattener{model, visibility, assets::world_transforms(model), {}};
    for (const int root : model.roots) flattener.descend(root, visibility.show.empty());
    return std::move(flattener.flat);
}

}  // namespace bolt::pathtrace
