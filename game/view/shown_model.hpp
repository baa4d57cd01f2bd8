// A model on the GPU with its lighting and its parts as entities, and how these are highlighted.
#pragma once

#include <memory>
#include <set>
#include <string>

#include "engine/render/camera.hpp"
#include "game/view/drawables.hpp"
#include "game/view/loaded_model.hpp"

namespace bolt::view {

struct ShownModel {
    render::GpuModel model;
    ModelWorld world;
    render::Scene scene;  // its objects are those that collect_objects() last found in the world
    render::BoundingBox box;
};

// A light over the viewer's left shoulder, which casts a shadow.
render::SceneLight key_light();

struct ShownModelOptions {
    bool key_light = true;  // adds key_light() to a model without lights
    bool levels = false;    // levels of detail; RendererOptions::level_error_px selects among them
};

// Uploads the model. `light` must outlive the result. Fails if the model has no mesh to draw.
Result<std::unique_ptr<ShownModel>> show_model(gpu::Device& device, const LoadedModel& model,
                                               const render::EnvironmentLight& light,
                                               const ShownModelOptions& options = {});

// A perspective for an eye at `eye` that looks at `target`; its depth range contains the whole box. `fov`:
// rad, vertical.
render::Perspective perspective_for(const render::BoundingBox& box, const glm::vec3& eye,
                                    const glm::vec3& target, float fov, float aspect);

// The direction of the default viewpoint from the model: above, in front and to the right; and its field of
// view.
inline const glm::vec3 default_direction{0.55F, 0.5F, 1.0F};
inline constexpr float default_fov = 0.6108652F;  // rad, 35°

// The viewpoint in the default direction that shows the whole box.
Viewpoint default_viewpoint(const render::BoundingBox& box, float fov, float aspect);

// Indices of the nodes of that name and of their descendants. Fails if there is no such node, and suggests
// the nearest name.
Result<std::set<int>> nodes_of(const assets::Model& model, const std::string& name);

// Names of nodes; each stands for the node with its descendants.
struct Highlights {
    std::vector<std::string> outlined, ghosts;  // ghosts are drawn translucent
    std::string revealed;  // drawn with everything in front of it cut away; empty: nothing is cut away
};

// Outlines a node with its descendants in `color`, and updates the scene. Fails as nodes_of().
Status outline(ShownModel& shown, const LoadedModel& model, const std::string& node, const glm::vec4& color);

// The bounding box of a node with its descendants; empty if none of them is drawn. Fails as nodes_of().
Result<render::BoundingBox> box_of(const ShownModel& shown, const LoadedModel& model,
                                   const std::string& node);

// Applies the highlights, and updates the scene. Fails as nodes_of(), or if the revealed node is not drawn.
Status highlight(ShownModel& shown, const LoadedModel& model, const Highlights& highlights);

}  // namespace bolt::view
