#include "tests/pathtrace/shapes.hpp"

#include <cmath>
#include <numbers>

namespace bolt::pathtrace {

assets::Model single(assets::Primitive primitive, const assets::Material& material) {
    assets::Model model;
    primitive.material = 0;
    model.meshes = {{.name = "mesh", .primitives = {std::move(primitive)}}};
    model.materials = {material};
    model.nodes = {{.name = "node", .mesh = 0}};
    model.roots = {0};
    return model;
}

assets::Primitive sphere(int meridians, int parallels) {
    assets::Primitive p;
    for (int j = 0; j <= parallels; ++j) {
        const float theta = std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(parallels);
        for (int i = 0; i <= meridians; ++i) {
            const float phi =
                2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(meridians);
            p.normals.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                   -std::sin(theta) * std::sin(phi));
        }
    }
    p.positions = p.normals;
    const auto row = static_cast<std::uint32_t>(meridians + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(parallels); ++j) {
        for (std::uint32_t i = 0; i < row - 1; ++i) {
            const std::uint32_t a = j * row + i;
            p.indices.insert(p.indices.end(), {a, a + row, a + 1, a + 1, a + row, a + row + 1});
        }
    }
    return p;
}

assets::Primitive square() {
    assets::Primitive p;
    p.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    p.normals.assign(4, {0, 0, 1});
    p.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    p.indices = {0, 1, 2, 0, 2, 3};
    return p;
}

assets::Material matte(const glm::vec3& color) {
    assets::Material material;
    material.base_color = glm::vec4(color, 1.0F);
    material.metallic = 0.0F;
    material.specular = 0.0F;
    return material;
}

}  // namespace bolt::pathtrace
