#include "game/view/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::view {

namespace {

// A key light over the viewer's left shoulder, as a photographer sets it.
render::SceneLight key_light() {
    render::SceneLight key;
    key.light.direction = glm::vec4(glm::normalize(glm::vec3(0.45F, -1.0F, -0.55F)), 0.0F);
    key.light.color = glm::vec4(1.6F, 1.55F, 1.5F, 0.0F);
    key.casts_shadow = true;
    return key;
}

}  // namespace

Result<std::unique_ptr<Stage>> set_stage(gpu::Device& device, const Subject& subject,
                                         const render::EnvironmentLight& light, const StageOptions& options) {
    auto stage = std::make_unique<Stage>();
    BOLT_TRY_ASSIGN(auto model, render::upload_model(device, subject.model, {options.levels}));
    stage->model = std::move(model);
    render::Scene& scene = stage->scene;
    render::add_model(scene, subject.model, stage->model);
    if (scene.objects.empty())
        return fail(ErrorCode::bad_content, fmt::format("{}: nothing in it can be drawn", subject.name),
                    "a mesh in the default scene");
    render::add_lights(scene, subject.model);
    if (scene.lights.empty() && options.key) scene.lights.push_back(key_light());
    scene.environment = &light;
    scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
    stage->box = render::bounds(scene);
    scene.occlusion_radius = 0.04F * glm::distance(stage->box.low, stage->box.high);
    return stage;
}

render::Perspective lens(const render::BoundingBox& box, const glm::vec3& eye, const glm::vec3& target,
                         float fov, float aspect) {
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = aspect;
    const float reach =
        glm::distance(eye, 0.5F * (box.low + box.high)) + 0.5F * glm::distance(box.low, box.high);
    lens.zfar = 1.05F * reach;
    // Nearer than what is looked at, however close one goes.
    lens.znear = std::min(0.005F * reach, 0.1F * glm::distance(eye, target));
    return lens;
}

Viewpoint framed(const render::BoundingBox& box, float fov, float aspect) {
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = aspect;
    return {"", render::framing_eye(box, usual_side, lens), 0.5F * (box.low + box.high), fov};
}

}  // namespace bolt::view
