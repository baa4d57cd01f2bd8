// The contents of a frame as values that are filled anew for every frame: objects, lights, environment,
// labels, eyes.
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

// Image-based light, prefiltered and uploaded to the GPU.
struct EnvironmentLight {
    gpu::Image levels;             // specular light; mips from sharp to rough
    shading::Harmonics diffuse{};  // diffuse light
};

// `size`: texels per side of a face of the sharpest level.
Result<EnvironmentLight> upload_environment(gpu::Device& device, const shading::RadianceImage& image,
                                            std::uint32_t size = 128);

// Uploads the table of directional albedos (engine/shading/ggx.hpp): the column is the square root of the
// cosine of the angle of view, the row is the roughness.
Result<gpu::Image> upload_albedo_table(gpu::Device& device);

enum class LabelPlacement : std::uint8_t {
    fixed,      // oriented by Label::orientation
    facing,     // faces the eye, with a fixed size in the scene
    on_screen,  // faces the eye, with a fixed size on the screen
};

// Text in the scene, such as the name of a joint or the torque at the wrench. It is drawn over the finished
// picture and is not lit. Colours are screen colours (sRGB, straight alpha).
struct Label {
    std::string text;  // UTF-8; lines end with \n
    glm::vec3 position{0.0F};
    LabelPlacement placement = LabelPlacement::on_screen;
    // For `fixed`: rotates a text that runs along x, with y up, seen from +z.
    glm::quat orientation{1.0F, 0.0F, 0.0F, 0.0F};
    float height = 16.0F;  // em size: pixels for `on_screen`, otherwise m
    // The point of the text that is at `position`: (0, 0) the lower left corner, (1, 1) the upper right one.
    // Lines are aligned accordingly.
    glm::vec2 anchor{0.5F, 0.5F};
    glm::vec2 offset_px{0.0F};  // on the screen, to the right and up
    glm::vec4 color{1.0F};
    glm::vec4 outline{0.0F};      // alpha 0: no outline
    float outline_width = 0.06F;  // em, up to 0.1
    glm::vec4 plate{0.0F};        // background behind the text; alpha 0: none
    // Share of the text that shows through parts in front of it: 0 hidden, 1 fully visible. Ghosts hide text
    // as opaque parts do.
    float occluded_visibility = 0.0F;
    float occlusion_margin = 0.0F;  // m: a part that is nearer to the text than this does not hide it
    bool operator==(const Label&) const = default;
};

// A flat picture in the scene, such as the user interface in a headset. It is drawn over the finished picture
// and is not lit; parts in front of it hide it.
struct Panel {
    const gpu::Image* picture = nullptr;  // of a PanelPicture (passes/panels.hpp)
    glm::vec3 centre{0.0F};               // m
    glm::vec3 right{0.0F}, up{0.0F};      // m, from the centre to the middles of the right and upper edges
    float opacity = 1.0F;
};

// An instance of a mesh.
struct Object {
    const GpuModel* model = nullptr;
    std::uint32_t mesh = 0;
    glm::mat4 world{1.0F};
    glm::vec4 tint{0.0F};  // w: the fraction of the material's colour that it replaces
    float opacity = 1.0F;  // below 1: a ghost, of which only the nearest layer is visible
    bool flat = false;     // unlit
    // Null: rigid. Create a new one for every pose, because the GPU may still use the previous one.
    std::shared_ptr<const Deformation> deformation = nullptr;
    bool moves = false;       // drawn into the shadow map anew in every frame
    bool cut = false;         // fades where it hides the focus of the scene's cut-away
    glm::vec4 outline{0.0F};  // colour of a line around it, visible through occluders; w: opacity
    int node = -1;            // the model's node that it was created from; -1: unknown
};

// Objects with Object::cut fade where they are between the eye and this sphere.
struct CutAway {
    glm::vec3 focus{0.0F};
    float radius = 0.03F;   // m, of the sphere around the focus that stays visible
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
    std::vector<Panel> panels;
    const EnvironmentLight* environment = nullptr;  // null: a black environment
    float environment_intensity = 1.0F;
    float environment_turn = 0.0F;  // rad, rotation about Y
    float exposure = 1.0F;
    float occlusion_radius = 0.0F;  // m, radius of ambient occlusion; 0: off
    glm::vec4 background{0.0F};     // w: 1 shows this colour, 0 the environment
    // Leaves the background black with alpha 0, and multiplies colours by alpha: to show the surroundings of
    // a headset behind the objects.
    bool transparent = false;
    CutAway cut_away;
    float outline_px = 3.0F;  // width of outlines
};

// A viewpoint with any projection whose depth is 1 near and 0 far.
struct Eye {
    glm::vec3 position{0.0F};
    glm::mat4 clip_from_world{1.0F};
    // The area of the picture that lenses hide from the user, as triangles of three corners each: x from −1
    // at the left edge to 1, y from −1 at the upper edge to 1. Null: there is no such area. Pixels in the
    // area are black, except where an outline or a label that shows through parts is drawn; Renderer::depth()
    // is 0 there.
    std::shared_ptr<const std::vector<glm::vec2>> hidden = nullptr;
};

// Adds the meshes of a model's default scene with its nodes in a pose, including skins and morph targets,
// transformed by `world`.
void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const assets::ModelPose& pose, const glm::mat4& world = glm::mat4(1.0F));
// The same in the rest pose.
void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const glm::mat4& world = glm::mat4(1.0F));

// Adds the KHR_lights_punctual lights of the model. Then the first directional light of the scene is moved to
// the front and casts a shadow.
void add_lights(Scene& scene, const assets::Model& model, const assets::ModelPose& pose,
                const glm::mat4& world = glm::mat4(1.0F));
void add_lights(Scene& scene, const assets::Model& model, const glm::mat4& world = glm::mat4(1.0F));

// Return whether an object casts a shadow (translucent and unlit ones do not), and whether light 0 casts the
// shadow of any object of the scene.
bool casts_shadow(const Object& object);
bool casts_shadow(const Scene& scene);

// Return bounds in world space, including deformation.
BoundingBox bounds(const Object& object, const MeshPart& part);
BoundingBox bounds(const Scene& scene);

}  // namespace bolt::render
