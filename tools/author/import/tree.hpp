// The assembly tree of the STEP file as nodes of the glTF scene (metres, Y up), and its conversion to a glTF
// model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

// A part with one colour override. Instances with the same part and the same colour use one mesh.
struct ColouredPart {
    int part = -1;
    std::optional<Colour> colour;  // of the instances; overrides the colour of the part
    std::size_t uses = 0;          // number of instances
};

struct TreeNode {
    std::string name;
    bool fixed = false;  // the name must stay; other nodes of this name are renamed
    ScaledPose local;
    int shape = -1;   // index into Tree::shapes; −1: no mesh
    int parent = -1;  // −1: a root
    std::vector<int> children;
};

struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<int> roots;
    std::vector<ColouredPart> shapes;
};

Tree make_tree(const StepDocument& document);

// Pose of the node in the scene.
ScaledPose world(const Tree& tree, int node);

// Makes `node` a child of `parent` (−1: a root) and keeps its pose in the scene.
void move_under(Tree& tree, int node, int parent);

// Returns the nearest common ancestor; −1 if there is none.
int common_parent(const Tree& tree, int a, int b);

// Appends _2, _3 … to duplicate names. Returns the number of renamed nodes.
int make_names_unique(Tree& tree);

// `meshes` is indexed by TreeNode::shape. The nodes of a mesh without primitives get no mesh.
assets::Model make_model(const Tree& tree, const std::vector<assets::Mesh>& meshes,
                         const std::vector<assets::Material>& materials);

}  // namespace bolt::step_import
