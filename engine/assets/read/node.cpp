#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "engine/assets/read/sections.hpp"

namespace bolt::assets {

namespace {

// Deeper than any real model, and shallow enough for recursive code.
constexpr int depth_limit = 256;

glm::vec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

// Decomposes an affine matrix without shear into translation, rotation and scale; a reflection gives a
// negative x scale.
Status decompose(const Document& document, const std::vector<double>& m, const std::string& pointer,
                 Node& node) {
    const glm::dvec3 columns[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
    glm::dvec3 scale{glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2])};
    const bool affine = m[3] == 0.0 && m[7] == 0.0 && m[11] == 0.0 && std::abs(m[15] - 1.0) < 1e-6;
    if (!affine) return error_at(document, pointer, "is no affine matrix", "0, 0, 0, 1 as its last row");
    if (std::min({scale.x, scale.y, scale.z}) < 1e-12)
        return error_at(document, pointer, "flattens what it moves", "scales other than zero");
    glm::dmat3 rotation(columns[0] / scale.x, columns[1] / scale.y, columns[2] / scale.z);
    const double shear =
        std::max({std::abs(glm::dot(rotation[0], rotation[1])), std::abs(glm::dot(rotation[1], rotation[2])),
                  std::abs(glm::dot(rotation[2], rotation[0]))});
    if (shear > 1e-3)
        return error_at(document, pointer, "shears", "a product of translation, rotation and scale");
    if (glm::determinant(rotation) < 0.0) {
        scale.x = -scale.x;
        rotation[0] = -rotation[0];
    }
    node.translation = {m[12], m[13], m[14]};
    node.rotation = glm::quat(glm::normalize(glm::quat_cast(rotation)));
    node.scale = scale;
    return {};
}

Status read_node(const Document& document, std::size_t index, Node& node) {
    const tinygltf::Node& from = document.gltf.nodes[index];
    const std::string pointer = fmt::format("/nodes/{}", index);
    node.name = from.name;
    node.children = from.children;
    node.mesh = from.mesh;
    node.skin = from.skin;
    node.camera = from.camera;
    if (from.matrix.size() == 16) {
        BOLT_TRY(decompose(document, from.matrix, pointer + "/matrix", node));
    } else {
        if (from.translation.size() == 3) node.translation = vec3(from.translation);
        if (from.scale.size() == 3) node.scale = vec3(from.scale);
        if (from.rotation.size() == 4) {
            const glm::dquat rotation(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]);
            if (std::abs(glm::length(rotation) - 1.0) > 1e-2)
                return error_at(document, pointer + "/rotation", "is no unit quaternion");
            // Normalize a nearly unit quaternion; keep the bits of one that is unit to float precision.
            const bool exact = std::abs(glm::length(rotation) - 1.0) < 1e-5;
            node.rotation = glm::quat(exact ? rotation : glm::normalize(rotation));
        }
    }
    for (const double weight : from.weights) node.weights.push_back(static_cast<float>(weight));
    const auto light = from.extensions.find("KHR_lights_punctual");
    if (light != from.extensions.end()) node.light = light->second.Get("light").GetNumberAsInt();
    const nlohmann::json& json = document.json["nodes"][index];
    if (json.contains("extras")) node.extras = json["extras"].dump();
    return {};
}

// Checks that every node has at most one parent and is not its own descendant.
Status check_tree(const Document& document, const Model& model) {
    std::vector<int> parents(model.nodes.size(), -1);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (std::size_t k = 0; k < model.nodes[i].children.size(); ++k) {
            int& parent = parents[static_cast<std::size_t>(model.nodes[i].children[k])];
            if (parent >= 0)
                return error_at(
                    document, fmt::format("/nodes/{}/children/{}", i, k),
                    fmt::format("node {} is a child of node {} already", model.nodes[i].children[k], parent));
            parent = static_cast<int>(i);
        }
    }
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        int depth = 0;
        for (int node = parents[i]; node >= 0; node = parents[static_cast<std::size_t>(node)]) {
            if (node == static_cast<int>(i))
                return error_at(document, fmt::format("/nodes/{}", i), "is below itself", "a tree of nodes");
            // A walk below a cycle never returns to its start: the depth limit ends it.
            if (++depth > depth_limit)
                return error_at(document, fmt::format("/nodes/{}", i),
                                fmt::format("lies deeper than {} nodes, or below a cycle", depth_limit));
        }
    }
    return {};
}

Status read_roots(const Document& document, Model& model) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const Node& node : model.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    if (document.gltf.scenes.empty()) {
        for (std::size_t i = 0; i < model.nodes.size(); ++i)
            if (!is_child[i]) model.roots.push_back(static_cast<int>(i));
        return {};
    }
    const auto scene = static_cast<std::size_t>(std::max(document.gltf.defaultScene, 0));
    std::vector<bool> listed(model.nodes.size(), false);
    const std::vector<int>& nodes = document.gltf.scenes[scene].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = static_cast<std::size_t>(nodes[i]);
        const std::string pointer = fmt::format("/scenes/{}/nodes/{}", scene, i);
        if (is_child[node]) return error_at(document, pointer, fmt::format("node {} is no root", node));
        if (listed[node]) return error_at(document, pointer, fmt::format("node {} is listed twice", node));
        listed[node] = true;
        model.roots.push_back(nodes[i]);
    }
    return {};
}

// Checks that meshes refer to joints of their node's skin, and that node weights match the morph targets.
Status check_uses(const Document& document, const Model& model) {
    std::vector<int> highest(model.meshes.size(), -1);
    for (std::size_t i = 0; i < model.meshes.size(); ++i)
        for (const Primitive& primitive : model.meshes[i].primitives)
            for (const glm::u16vec4& joints : primitive.joints)
                highest[i] = std::max({highest[i], static_cast<int>(joints.x), static_cast<int>(joints.y),
                                       static_cast<int>(joints.z), static_cast<int>(joints.w)});
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        if (node.mesh < 0) continue;
        const auto mesh = static_cast<std::size_t>(node.mesh);
        if (!node.weights.empty() && node.weights.size() != model.meshes[mesh].primitives[0].targets.size())
            return error_at(document, fmt::format("/nodes/{}/weights", i),
                            "has not one weight a morph target");
        if (node.skin < 0) continue;
        const std::size_t joints = model.skins[static_cast<std::size_t>(node.skin)].joints.size();
        if (highest[mesh] >= static_cast<int>(joints))
            return error_at(
                document, fmt::format("/nodes/{}/skin", i),
                fmt::format("mesh {} names joint {} of a skin of {}", mesh, highest[mesh], joints));
    }
    return {};
}

}  // namespace

Status read_nodes(const Document& document, Model& model) {
    model.nodes.resize(document.gltf.nodes.size());
    Status done;
    for (std::size_t i = 0; done && i < model.nodes.size(); ++i)
        done = read_node(document, i, model.nodes[i]);
    if (done) done = check_tree(document, model);
    if (done) done = read_roots(document, model);
    if (done) done = check_uses(document, model);
    return done;
}

}  // namespace bolt::assets
