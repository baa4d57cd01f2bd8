#include "tools/author/import/scene.hpp"

namespace bolt::step_import {

assets::Model make_model(const Tree& tree, const std::vector<assets::Mesh>& meshes,
                         const std::vector<assets::Material>& materials) {
    assets::Model model;
    model.generator = "Boltwright bolt-author import-step";
    model.materials = materials;
    model.roots = tree.roots;
    std::vector<int> mesh_of(meshes.size(), -1);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i].primitives.empty()) continue;
        mesh_of[i] = static_cast<int>(model.meshes.size());
        model.meshes.push_back(meshes[i]);
    }
    for (const TreeNode& node : tree.nodes) {
        assets::Node made;
        made.name = node.name;
        made.translation = glm::vec3(node.local.position);
        made.rotation = glm::quat(node.local.rotation);
        made.scale = glm::vec3(static_cast<float>(node.local.scale));
        made.children = node.children;
        if (node.shape >= 0) made.mesh = mesh_of[static_cast<std::size_t>(node.shape)];
        model.nodes.push_back(std::move(made));
    }
    return model;
}

}  // namespace bolt::step_import
