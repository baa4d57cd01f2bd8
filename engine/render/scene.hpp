// What is to be drawn: plain values, filled anew for every frame.
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
    glm::vec4 tint{0.0F};  // w: how much of the material's colour it replaces
    float opacity = 1.0F;  // below 1: a ghost, of which only what is nearest shows
    bool flat = false;     // its own colour, without light
    // What bends it; null: nothing. A new one for every pose: what was rendered may still be looked at.
    std::shared_ptr<const Deformation> deformation = nullptr;
    bool moves = false;       // drawn into the shadow map anew each frame
    bool cut = false;         // fades where it hides what the scene's cut-away wants to be seen
    glm::vec4 outline{0.0F};  // a line around it, through whatever hides it; w: its opacity
    int node = -1;            // of the model that it came from; for those who look for it
};

// What must be seen: between it and the eye, objects that allow it fade.
struct CutAway {
    glm::vec3 focus{0.0F};
    float radius = 0.03F;   // m, kept free around it
    float strength = 0.0F;  // 0: nothing fades … 1: what hides it goes
};

struct SceneLight {
    shared::Light light{};
    bool casts_shadow = false;  // the first light only, if it is directional
};

struct Scene {
    std::vector<Object> objects;
    std::vector<SceneLight> lights;
    std::vector<Label> labels;
    const EnvironmentLight* environment = nullptr;
    float environment_intensity = 1.0F;
    float environment_turn = 0.0F;  // rad about Y
    float exposure = 1.0F;
    float occlusion_radius = 0.0F;  // m, how far parts keep light from each other; 0: not at all
    glm::vec4 background{0.0F};     // w: 1 shows it, 0 the environment
    CutAway cut_away;
    float outline_px = 3.0F;
};

// A point of view. Any projection with depth 1 near and 0 far.
struct Eye {
    glm::vec3 position{0.0F};
    glm::mat4 clip_from_world{1.0F};
};

// The meshes of a model's default scene where its nodes stand in a pose, skins and morph targets too, moved
// by `world`.
void place(Scene& scene, const assets::Model& model, const GpuModel& gpu_model, const assets::Pose& pose,
           const glm::mat4& world = glm::mat4(1.0F));
// At rest.
void place(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
           const glm::mat4& world = glm::mat4(1.0F));

// KHR_lights_punctual lights of the model. The first directional one is moved to the front and casts a
// shadow.
void place_lights(Scene& scene, const assets::Model& model, const assets::Pose& pose,
                  const glm::mat4& world = glm::mat4(1.0F));
void place_lights(Scene& scene, const assets::Model& model, const glm::mat4& world = glm::mat4(1.0F));

// Whether an object gives shadow, and whether light 0 throws one in this scene.
bool casts_shadow(const Object& object);
bool casts_shadow(const Scene& scene);

// Of a part of an object's model, in the world, as the object is bent.
Box bounds(const Object& object, const Part& part);
Box bounds(const Scene& scene);

}  // namespace bolt::render
