#include "tests/golden/golden_studio.hpp"

#include <glm/geometric.hpp>

namespace bolt::test {

render::Scene GoldenStudio::scene() {
    render::Scene scene;
    scene.environment = &light;
    scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
    return scene;
}

void GoldenStudio::check(const std::string& name, const render::Picture& picture) {
    const PictureComparison comparison = compare_with_reference(pictures, name, picture);
    CHECK_MESSAGE(comparison.passes, comparison.why);
}

void GoldenStudio::shoot(const std::string& name, const render::Scene& scene, const render::Eye& eye,
                         VkExtent2D extent) {
    check(name, studio.shoot(scene, eye, extent));
}

render::Eye eye_at(const glm::vec3& eye, const glm::vec3& target, float fov, float aspect) {
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = aspect;
    return render::make_eye(eye, target, lens);
}

render::SceneLight lamp(const glm::vec3& direction, float strength) {
    render::SceneLight lamp;
    lamp.light.direction = glm::vec4(glm::normalize(direction), 0.0F);
    lamp.light.color = glm::vec4(glm::vec3(strength), 0.0F);
    lamp.casts_shadow = true;
    return lamp;
}

glm::mat4 at(const glm::vec3& place, const glm::vec3& scale) {
    glm::mat4 world(1.0F);
    for (int i = 0; i < 3; ++i) world[i][i] = scale[i];
    world[3] = glm::vec4(place, 1.0F);
    return world;
}

assets::Material paint(const glm::vec3& color, float roughness) {
    assets::Material m;
    m.base_color = glm::vec4(color, 1.0F);
    m.metallic = 0.0F;
    m.roughness = roughness;
    return m;
}

assets::Material metal(const glm::vec3& color, float roughness) {
    assets::Material m = paint(color, roughness);
    m.metallic = 1.0F;
    return m;
}

assets::Model globe(const assets::Material& material) {
    constexpr int rings = 48, around = 2 * rings;
    assets::Model model = sphere(material, rings);
    assets::Primitive& p = model.meshes[0].primitives[0];
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= around; ++j) {
            const glm::vec3& n = p.normals[static_cast<std::size_t>(i * (around + 1) + j)];
            const glm::vec3 east(n.z, 0.0F, -n.x);
            p.tangents.push_back(i == 0 || i == rings ? glm::vec4(1, 0, 0, 1)
                                                      : glm::vec4(glm::normalize(east), 1.0F));
            p.texcoords[0].emplace_back(static_cast<float>(j) / around, static_cast<float>(i) / rings);
        }
    return model;
}

assets::Model cube(const assets::Material& material, bool tangents) {
    assets::Model model = plate(material);
    assets::Primitive& p = model.meshes[0].primitives[0];
    p.positions.clear();
    p.normals.clear();
    p.indices.clear();
    for (int face = 0; face < 6; ++face) {
        glm::vec3 normal(0.0F);
        normal[face / 2] = face % 2 == 0 ? 1.0F : -1.0F;
        const glm::vec3 up = face / 2 == 1 ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
        const glm::vec3 right = glm::cross(up, normal);
        const auto first = static_cast<std::uint32_t>(p.positions.size());
        for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
            p.positions.push_back(normal + x * right + y * up);
            p.normals.push_back(normal);
            if (tangents) p.tangents.emplace_back(right, 1.0F);
            p.texcoords[0].emplace_back(0.5F + 0.5F * x, 0.5F - 0.5F * y);
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) p.indices.push_back(first + corner);
    }
    return model;
}

}  // namespace bolt::test
