#include "engine/assets/model.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <numeric>
#include <utility>

namespace bolt::assets {

namespace {

void shift(int& index, std::size_t by) {
    if (index >= 0) index += static_cast<int>(by);
}

void shift_textures(Material& material, std::size_t by) {
    for (TextureRef* texture :
         {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
          &material.occlusion_texture, &material.emissive_texture, &material.clearcoat_texture,
          &material.clearcoat_roughness_texture, &material.clearcoat_normal_texture,
          &material.anisotropy_texture, &material.specular_texture, &material.specular_color_texture})
        shift(texture->texture, by);
}

template <class T>
void move_to_end(std::vector<T>& all, std::vector<T>& added) {
    all.insert(all.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
}

}  // namespace

void append(Model& model, Model added) {
    for (Node& node : added.nodes) {
        for (int& child : node.children) shift(child, model.nodes.size());
        shift(node.mesh, model.meshes.size());
        shift(node.skin, model.skins.size());
        shift(node.camera, model.cameras.size());
        shift(node.light, model.lights.size());
    }
    for (int& root : added.roots) shift(root, model.nodes.size());
    for (Mesh& mesh : added.meshes)
        for (Primitive& primitive : mesh.primitives) shift(primitive.material, model.materials.size());
    for (Material& material : added.materials) shift_textures(material, model.textures.size());
    for (Texture& texture : added.textures) shift(texture.image, model.images.size());
    for (Skin& skin : added.skins) {
        for (int& joint : skin.joints) shift(joint, model.nodes.size());
        shift(skin.skeleton, model.nodes.size());
    }
    for (Animation& animation : added.animations)
        for (AnimationChannel& channel : animation.channels) shift(channel.node, model.nodes.size());
    move_to_end(model.nodes, added.nodes);
    move_to_end(model.roots, added.roots);
    move_to_end(model.meshes, added.meshes);
    move_to_end(model.materials, added.materials);
    move_to_end(model.textures, added.textures);
    move_to_end(model.images, added.images);
    move_to_end(model.skins, added.skins);
    move_to_end(model.lights, added.lights);
    move_to_end(model.cameras, added.cameras);
    move_to_end(model.animations, added.animations);
}

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

glm::mat4 local_transform(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale) {
    return glm::translate(glm::mat4(1.0F), translation) * glm::mat4_cast(rotation) *
           glm::scale(glm::mat4(1.0F), scale);
}

std::vector<glm::mat4> world_transforms(const Model& model) {
    std::vector<glm::mat4> local;
    for (const Node& node : model.nodes)
        local.push_back(local_transform(node.translation, node.rotation, node.scale));
    return world_transforms(model, local);
}

std::vector<glm::mat4> world_transforms(const Model& model, std::span<const glm::mat4> local) {
    std::vector<glm::mat4> world(local.begin(), local.end());
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const Node& node : model.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!is_child[i]) pending.push_back(i);
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        for (const int index : model.nodes[node].children) {
            const auto child = static_cast<std::size_t>(index);
            world[child] = world[node] * local[child];
            pending.push_back(child);
        }
    }
    return world;
}

}  // namespace bolt::assets
