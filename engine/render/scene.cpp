#include "engine/render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/assets/topology.hpp"

namespace bolt::render {

namespace {

// Visits the nodes of the default scene.
template <class Visit>
void walk(const assets::Model& model, const Visit& visit) {
    std::vector<int> waiting(model.roots.rbegin(), model.roots.rend());
    while (!waiting.empty()) {
        const auto node = static_cast<std::size_t>(waiting.back());
        waiting.pop_back();
        visit(node);
        waiting.insert(waiting.end(), model.nodes[node].children.rbegin(), model.nodes[node].children.rend());
    }
}

shared::Light make_light(const assets::Light& light, const glm::mat4& world) {
    shared::Light to{};
    const glm::vec3 forward = -glm::normalize(glm::vec3(world[2]));
    to.color = glm::vec4(light.color * light.intensity, 0.0F);
    to.direction = glm::vec4(forward, light.range);
    to.position = glm::vec4(glm::vec3(world[3]), light.type == assets::LightType::directional ? 0.0F
                                                 : light.type == assets::LightType::point     ? 1.0F
                                                                                              : 2.0F);
    const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
    to.cone.x = 1.0F / std::max(inner - outer, 1e-3F);
    to.cone.y = -outer * to.cone.x;
    return to;
}

}  // namespace

void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const assets::ModelPose& pose, const glm::mat4& world) {
    const std::vector<glm::mat4> transforms = assets::world_transforms(model, pose);
    walk(model, [&](std::size_t index) {
        const assets::Node& node = model.nodes[index];
        if (node.mesh < 0) return;
        Object object;
        object.model = &gpu_model;
        object.mesh = static_cast<std::uint32_t>(node.mesh);
        object.node = static_cast<int>(index);
        // glTF 2.0, 3.7.3.3: the joints alone place a skinned mesh, not its node.
        object.world = node.skin >= 0 ? world : world * transforms[index];
        const std::vector<float>& weights = pose[index].weights;
        const bool morphs = std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0.0F; });
        if (node.skin >= 0 || morphs) {
            Deformation deformation{{}, weights};
            if (node.skin >= 0)
                deformation.joints =
                    assets::joint_matrices(model.skins[static_cast<std::size_t>(node.skin)], transforms);
            object.deformation = std::make_shared<const Deformation>(std::move(deformation));
        }
        scene.objects.push_back(object);
    });
}

void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model, const glm::mat4& world) {
    add_model(scene, model, gpu_model, assets::rest_pose(model), world);
}

void add_lights(Scene& scene, const assets::Model& model, const glm::mat4& world) {
    add_lights(scene, model, assets::rest_pose(model), world);
}

void add_lights(Scene& scene, const assets::Model& model, const assets::ModelPose& pose,
                const glm::mat4& world) {
    const std::vector<glm::mat4> transforms = assets::world_transforms(model, pose);
    walk(model, [&](std::size_t node) {
        if (model.nodes[node].light < 0) return;
        const assets::Light& light = model.lights[static_cast<std::size_t>(model.nodes[node].light)];
        scene.lights.push_back({make_light(light, world * transforms[node]), false});
    });
    const auto directional = std::find_if(scene.lights.begin(), scene.lights.end(),
                                          [](const SceneLight& l) { return l.light.position.w == 0.0F; });
    if (directional == scene.lights.end()) return;
    std::rotate(scene.lights.begin(), directional, directional + 1);
    scene.lights.front().casts_shadow = true;
}

bool casts_shadow(const Object& object) { return object.opacity >= 1.0F && !object.flat; }

bool casts_shadow(const Scene& scene) {
    return !scene.lights.empty() && scene.lights.front().casts_shadow &&
           scene.lights.front().light.position.w == 0.0F &&
           std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const Object& object) { return casts_shadow(object); });
}

BoundingBox bounds(const Object& object, const MeshPart& part) {
    return transformed(bounds(part.box, part.bends, object.deformation.get()), object.world);
}

BoundingBox bounds(const Scene& scene) {
    BoundingBox box;
    for (const Object& object : scene.objects) {
        const MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = 0; i < range.count; ++i) {
            const BoundingBox moved = bounds(object, object.model->parts[range.first + i]);
            box.add(moved.low);
            box.add(moved.high);
        }
    }
    return box;
}

}  // namespace bolt::render
