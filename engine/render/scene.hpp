// The contents of a frame: plain values, filled anew for every frame.
#pragma once

#include <memory>

#include "engine/assets/pose.hpp"
#include "engine/render/environment_light.hpp"
#include "engine/render/gpu_model.hpp"
#include "engine/render/label.hpp"

namespace bolt::render {

struct Object {
    const GpuModel* model = nullptr;
    std::uint32_t mesh = 0;
    glm::mat4 world{1.0F};
    glm::vec4 tint{0.0F};  // w: the fraction of the material's colour that it replaces
    float opacity = 1.0F;  // below 1: a ghost, whose nearest layer only is visible
    bool flat = false;     // unlit
    // Joints and weights; null: rigid. Create a new one for every pose: the GPU may still use the previous
    // one.
    std::shared_ptr<const Deformation> deformation = nullptr;
    bool moves = false;       // drawn into the shadow map in every frame
    bool cut = false;         // fades where it hides the focus of the scene's cut-away
    glm::vec4 outline{0.0F};  // a line around it, visible through occluders; w: opacity
    int node = -1;            // the model's node that it was created from; -1: unknown
};

// Objects with `cut` set fade between the eye and this sphere.
struct CutAway {
    glm::vec3 focus{0.0F};
    float radius = 0.03F;   // m, kept visible around the focus
    float strength = 0.0F;  // 0: no fading … 1: full fading
};

struct SceneLight {
    shared::Light light{};
    bool casts_shadow = false;  // only for the first light, if it is directional
};

struct Scene {
    std::vector<Object> objects;
    std::vector<SceneLight> lights;
    std::vector<Label> labels;
    const EnvironmentLight* environment = nullptr;
    float environment_intensity = 1.0F;
    float environment_turn = 0.0F;  // rad, rotation about Y
    float exposure = 1.0F;
    float occlusion_radius = 0.0F;  // m, radius of ambient occlusion; 0: off
    glm::vec4 background{0.0F};     // w: 1 shows this colour, 0 the environment
    CutAway cut_away;
    float outline_px = 3.0F;
};

// A viewpoint with any projection that has depth 1 near and 0 far.
struct Eye {
    glm::vec3 position{0.0F};
    glm::mat4 clip_from_world{1.0F};
};

// Adds the meshes of a model's default scene with its nodes in a pose, including skins and morph targets,
// transformed by `world`.
void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const assets::ModelPose& pose, const glm::mat4& world = glm::mat4(1.0F));
// The same in the rest pose.
void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const glm::mat4& world = glm::mat4(1.0F));

// Adds the KHR_lights_punctual lights of the model. The first directional one is moved to the front and casts
// a shadow.
void add_lights(Scene& scene, const assets::Model& model, const assets::ModelPose& pose,
                const glm::mat4& world = glm::mat4(1.0F));
void add_lights(Scene& scene, const assets::Model& model, const glm::mat4& world = glm::mat4(1.0F));

// Whether an object casts a shadow, and whether light 0 casts shadows in this scene.
bool casts_shadow(const Object& object);
bool casts_shadow(const Scene& scene);

// The world bounds of a part of an object, including its deformation.
BoundingBox bounds(const Object& object, const MeshPart& part);
BoundingBox bounds(const Scene& scene);

}  // namespace bolt::render
