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

}  // namespace bolt::view
