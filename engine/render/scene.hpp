// Image-based lighting, prefiltered and uploaded to the GPU.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>

#include "engine/assets/pose.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/gpu_model.hpp"
#include "engine/shading/environment.hpp"

namespace bolt::render {

struct EnvironmentLight {
    gpu::Image levels;  // specular mips, from sharp to rough
    shading::Harmonics diffuse{};
};

Result<EnvironmentLight> upload_environment(gpu::Device& device, const shading::RadianceImage& image,
                                            std::uint32_t size = 128);

// Uploads the table of directional albedos (engine/shading/ggx.hpp): columns √cos, rows roughness.
Result<gpu::Image> upload_albedo_table(gpu::Device& device);

// Text in the scene, such as the names of joints and the torque at the wrench.

enum class LabelPlacement : std::uint8_t {
    fixed,      // oriented by `turn`
    facing,     // turned to the eye, with a fixed size in the scene
    on_screen,  // turned to the eye, with a fixed size on the screen
};

// Text is drawn over the finished picture and is not lit. Colours are screen colours (sRGB, straight alpha).
struct Label {
    std::string text;  // UTF-8; lines end with \n
    glm::vec3 position{0.0F};
    LabelPlacement stand = LabelPlacement::on_screen;
    glm::quat turn{1.0F, 0.0F, 0.0F, 0.0F};  // `fixed`: turns a text along x, with y up, seen from +z
    float height = 16.0F;                    // em size: pixels for `on_screen`, otherwise m
    // The point of the text at `position`: (0, 0) is its lower left corner, (1, 1) its upper right one. Lines
    // are aligned the same way.
    glm::vec2 anchor{0.5F, 0.5F};
    glm::vec2 moved_px{0.0F};  // offset on the screen, to the right and up
    glm::vec4 color{1.0F};
    glm::vec4 outline{0.0F};      // alpha 0: no outline
    float outline_width = 0.06F;  // em, up to 0.1
    glm::vec4 plate{0.0F};        // background behind the text; alpha 0: none
    // Visible fraction behind other parts: 0 hidden, 1 fully visible. Ghosts hide text like opaque parts.
    float through = 0.0F;
    float before = 0.0F;  // m: parts hide the text only if they are farther in front than this
};

// The contents of a frame: plain values, filled anew for every frame.

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
