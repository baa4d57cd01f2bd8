// A subject on the GPU, in its light, ready to be drawn from anywhere.
#pragma once

#include <memory>

#include "engine/render/camera.hpp"
#include "game/view/loaded_model.hpp"

namespace bolt::view {

struct Stage {
    render::GpuModel model;
    render::Scene scene;  // points to the model and to the light
    render::BoundingBox box;
};

struct StageOptions {
    bool key = true;      // a lamp for models that have none
    bool levels = false;  // of detail; RendererOptions::level_error_px chooses
};

// The light has to outlive the stage.
Result<std::unique_ptr<Stage>> set_stage(gpu::Device& device, const Subject& subject,
                                         const render::EnvironmentLight& light,
                                         const StageOptions& options = {});

// A lens for a look from `eye` to `target`, deep enough for the whole stage.
render::Perspective lens(const render::BoundingBox& box, const glm::vec3& eye, const glm::vec3& target,
                         float fov, float aspect);

// Where models are looked at from when nobody says: from above, in front and to the right.
inline const glm::vec3 usual_side{0.55F, 0.5F, 1.0F};
inline constexpr float usual_fov = 0.6108652F;  // rad, 35°

// All of the stage, from there.
Viewpoint framed(const render::BoundingBox& box, float fov, float aspect);

// What a picture points at: outlines, ghosts, and a part that is seen through whatever hides it.

// Names of nodes; what hangs below them is meant too.
struct Marks {
    std::vector<std::string> outlined, ghosts;
    std::string seen;  // empty: nothing is cut away
};

// A line of that colour around the node and what hangs below it.
Status outline(Stage& stage, const Subject& subject, const std::string& node, const glm::vec4& color);

// Around the node and what hangs below it; empty where nothing of it is drawn.
Result<render::BoundingBox> box_of(const Stage& stage, const Subject& subject, const std::string& node);

// An error names the node that is nearest to one that is not there.
Status mark(Stage& stage, const Subject& subject, const Marks& marks);

}  // namespace bolt::view
