// A model with every instance in its place: nodes by name, parts as triangles in the assembly's frame.
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/geometry/box.hpp"

namespace bolt::geometry {

struct SceneNode {
    std::string name;
    int parent = -1;
    glm::dmat4 world{1.0};
};

// A node's mesh.
struct Part {
    std::string name;  // of the node, or of the nearest one above it that has a name
    int node = -1;     // of the scene
    std::vector<Triangle> triangles;
    Box box;
};

struct Scene {
    std::vector<SceneNode> nodes;  // a parent before its children
    std::vector<Part> parts;
    std::map<std::string, std::vector<int>, std::less<>> by_name;

    [[nodiscard]] bool is_under(int node, int ancestor) const;  // or is the same
    [[nodiscard]] std::size_t triangle_count() const;
    [[nodiscard]] std::vector<std::string> names() const;
};

Scene flatten(const assets::Model& model);

}  // namespace bolt::geometry
