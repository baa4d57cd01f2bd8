#include "game/view/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

#include "engine/base/nearest.hpp"

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

namespace {

constexpr glm::vec4 outline_color{1.0F, 0.78F, 0.1F, 1.0F};
constexpr float ghost_opacity = 0.35F;
constexpr float free_radius = 0.65F;  // of the seen part's diagonal

// The nodes of that name and all below them.
Result<std::set<int>> nodes_of(const assets::Model& model, const std::string& name) {
    std::vector<int> waiting;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        if (model.nodes[i].name == name) waiting.push_back(static_cast<int>(i));
        if (!model.nodes[i].name.empty()) names.push_back(model.nodes[i].name);
    }
    if (waiting.empty()) {
        const std::string near = nearest(name, names);
        return fail(
            ErrorCode::usage, fmt::format("the model has no node \"{}\"", name),
            near.empty() ? fmt::format("one of its {} nodes", names.size()) : fmt::format("\"{}\"", near));
    }
    std::set<int> nodes;
    while (!waiting.empty()) {
        const int node = waiting.back();
        waiting.pop_back();
        if (!nodes.insert(node).second) continue;
        const std::vector<int>& children = model.nodes[static_cast<std::size_t>(node)].children;
        waiting.insert(waiting.end(), children.begin(), children.end());
    }
    return nodes;
}

template <class Objects, class Do>
Status each(Objects& objects, const Subject& subject, const std::string& name, const Do& what) {
    BOLT_TRY_ASSIGN(const auto nodes, nodes_of(subject.model, name));
    for (auto& object : objects)
        if (nodes.contains(object.node)) what(object);
    return {};
}

}  // namespace

Status outline(Stage& stage, const Subject& subject, const std::string& node, const glm::vec4& color) {
    return each(stage.scene.objects, subject, node, [&](render::Object& object) { object.outline = color; });
}

Result<render::BoundingBox> box_of(const Stage& stage, const Subject& subject, const std::string& node) {
    render::Scene some;
    BOLT_TRY(each(stage.scene.objects, subject, node,
                  [&](const render::Object& object) { some.objects.push_back(object); }));
    return render::bounds(some);
}

Status mark(Stage& stage, const Subject& subject, const Marks& marks) {
    std::vector<render::Object>& objects = stage.scene.objects;
    for (const std::string& name : marks.outlined) BOLT_TRY(outline(stage, subject, name, outline_color));
    for (const std::string& name : marks.ghosts)
        if (Status s = each(objects, subject, name, [](render::Object& o) { o.opacity = ghost_opacity; }); !s)
            return s;
    if (marks.seen.empty()) return {};
    for (render::Object& object : objects) object.cut = true;
    if (Status s = each(objects, subject, marks.seen, [](render::Object& o) { o.cut = false; }); !s) return s;
    BOLT_TRY_ASSIGN(const auto seen, box_of(stage, subject, marks.seen));
    if (seen.empty())
        return fail(ErrorCode::usage, fmt::format("there is nothing to see at the node \"{}\"", marks.seen),
                    "a node with a mesh");
    stage.scene.cut_away = {0.5F * (seen.low + seen.high), free_radius * glm::distance(seen.low, seen.high),
                            1.0F};
    return {};
}

}  // namespace bolt::view
