#include "tools/author/import/tree.hpp"

#include <algorithm>

#include "tools/author/import/names.hpp"

namespace bolt::step_import {

namespace {

TreeNode& at(Tree& tree, int node) { return tree.nodes[static_cast<std::size_t>(node)]; }
const TreeNode& at(const Tree& tree, int node) { return tree.nodes[static_cast<std::size_t>(node)]; }

int shape_for(Tree& tree, int part, const std::optional<Colour>& colour) {
    for (std::size_t i = 0; i < tree.shapes.size(); ++i)
        if (tree.shapes[i].part == part && tree.shapes[i].colour == colour) return static_cast<int>(i);
    tree.shapes.push_back({part, colour, 0});
    return static_cast<int>(tree.shapes.size()) - 1;
}

}  // namespace

Tree make_tree(const StepDocument& document) {
    Tree tree;
    tree.roots = document.roots;
    tree.nodes.resize(document.instances.size());
    for (std::size_t i = 0; i < document.instances.size(); ++i) {
        const StepInstance& instance = document.instances[i];
        TreeNode& node = tree.nodes[i];
        node.name = instance.name;
        node.local = to_scene(instance.placement);
        node.children = instance.children;
        for (const int child : instance.children) at(tree, child).parent = static_cast<int>(i);
        if (instance.part < 0) continue;
        // An instance with the part's own colour shares the mesh of the part.
        const StepPart& part = document.parts[static_cast<std::size_t>(instance.part)];
        const bool same = instance.colour == part.colour;
        node.shape = shape_for(tree, instance.part, same ? std::nullopt : instance.colour);
        ++tree.shapes[static_cast<std::size_t>(node.shape)].uses;
    }
    return tree;
}

ScaledPose world(const Tree& tree, int node) {
    ScaledPose pose = at(tree, node).local;
    for (int up = at(tree, node).parent; up >= 0; up = at(tree, up).parent) pose = at(tree, up).local * pose;
    return pose;
}

void move_under(Tree& tree, int node, int parent) {
    const ScaledPose pose = world(tree, node);
    TreeNode& moved = at(tree, node);
    std::vector<int>& old = moved.parent >= 0 ? at(tree, moved.parent).children : tree.roots;
    std::erase(old, node);
    moved.local = parent >= 0 ? inverse(world(tree, parent)) * pose : pose;
    moved.parent = parent;
    (parent >= 0 ? at(tree, parent).children : tree.roots).push_back(node);
}

int common_parent(const Tree& tree, int a, int b) {
    std::vector<int> above;
    for (int up = at(tree, a).parent; up >= 0; up = at(tree, up).parent) above.push_back(up);
    for (int up = at(tree, b).parent; up >= 0; up = at(tree, up).parent)
        if (std::find(above.begin(), above.end(), up) != above.end()) return up;
    return -1;
}

int make_names_unique(Tree& tree) {
    UniqueNames names;
    for (const bool fixed : {true, false})
        for (TreeNode& node : tree.nodes)
            if (node.fixed == fixed) node.name = names.claim(node.name);
    return names.renamed();
}

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
