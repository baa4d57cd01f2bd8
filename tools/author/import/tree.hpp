// The nodes of the glTF scene: the assembly tree of the file in the scene's frame, with unique names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

// A part under one colouring: one mesh, however often it is placed.
struct Shape {
    int part = -1;
    std::optional<Colour> colour;  // of the uses; stronger than the part's
    std::size_t uses = 0;
};

struct TreeNode {
    std::string name;
    bool fixed = false;  // the name is needed as it is: others give way
    Placement local;
    int shape = -1;
    int parent = -1;
    std::vector<int> children;
};

struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<int> roots;
    std::vector<Shape> shapes;
};

Tree make_tree(const StepDocument& document);

Placement world(const Tree& tree, int node);

// Puts `node` under `parent` (−1: a root) where it stands in the world.
void move_under(Tree& tree, int node, int parent);

// The nearest node that both are under; −1: none.
int common_parent(const Tree& tree, int a, int b);

// Adds _2, _3 … where a name is taken; returns how many had to be changed.
int make_names_unique(Tree& tree);

// The tree with one mesh a shape, as a glTF model.

// `meshes`: by TreeNode::shape; one without primitives leaves its nodes empty.
assets::Model make_model(const Tree& tree, const std::vector<assets::Mesh>& meshes,
                         const std::vector<assets::Material>& materials);

}  // namespace bolt::step_import
