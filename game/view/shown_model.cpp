#include "game/view/shown_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/base/nearest.hpp"

namespace bolt::view {

render::SceneLight key_light() {
    render::SceneLight key;
    key.light.direction = glm::vec4(glm::normalize(glm::vec3(0.45F, -1.0F, -0.55F)), 0.0F);
    key.light.color = glm::vec4(1.6F, 1.55F, 1.5F, 0.0F);
    key.casts_shadow = true;
    return key;
}

Result<std::unique_ptr<ShownModel>> show_model(gpu::Device& device, const LoadedModel& model,
                                               const render::EnvironmentLight& light,
                                               const ShownModelOptions& options) {
    auto shown = std::make_unique<ShownModel>();
    BOLT_TRY_ASSIGN(auto uploaded, render::upload_model(device, model.model, {options.levels}));
    shown->model = std::move(uploaded);
    render::Scene parts;
    render::add_model(parts, model.model, shown->model);
    for (const render::Object& object : parts.objects) (void)add_drawable(shown->world, object);
    render::Scene& scene = shown->scene;
    collect_objects(shown->world, scene);
    if (scene.objects.empty())
        return fail(ErrorCode::bad_content, fmt::format("{}: has nothing to draw", model.name),
                    "a mesh in the default scene");
    render::add_lights(scene, model.model);
    if (scene.lights.empty() && options.key_light) scene.lights.push_back(key_light());
    scene.environment = &light;
    scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
    shown->box = render::bounds(scene);
    scene.occlusion_radius = 0.04F * glm::distance(shown->box.low, shown->box.high);
    return shown;
}

render::Perspective perspective_for(const render::BoundingBox& box, const glm::vec3& eye,
                                    const glm::vec3& target, float fov, float aspect) {
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = aspect;
    const float reach =
        glm::distance(eye, 0.5F * (box.low + box.high)) + 0.5F * glm::distance(box.low, box.high);
    lens.zfar = 1.05F * reach;
    // The near plane is nearer than the target at any distance.
    lens.znear = std::min(0.005F * reach, 0.1F * glm::distance(eye, target));
    return lens;
}

Viewpoint default_viewpoint(const render::BoundingBox& box, float fov, float aspect) {
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = aspect;
    return {"", render::framing_eye(box, default_direction, lens), 0.5F * (box.low + box.high), fov};
}

Result<std::set<int>> nodes_of(const assets::Model& model, const std::string& name) {
    std::vector<int> pending;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        if (model.nodes[i].name == name) pending.push_back(static_cast<int>(i));
        if (!model.nodes[i].name.empty()) names.push_back(model.nodes[i].name);
    }
    if (pending.empty()) {
        const std::string near = nearest(name, names);
        return fail(ErrorCode::usage, fmt::format("the model has no node \"{}\"", name),
                    near.empty() ? fmt::format("one of its {} nodes", names.size())
                                 : fmt::format("did you mean \"{}\"?", near));
    }
    std::set<int> nodes;
    while (!pending.empty()) {
        const int node = pending.back();
        pending.pop_back();
        if (!nodes.insert(node).second) continue;
        const std::vector<int>& children = model.nodes[static_cast<std::size_t>(node)].children;
        pending.insert(pending.end(), children.begin(), children.end());
    }
    return nodes;
}

namespace {

constexpr glm::vec4 outline_color{1.0F, 0.78F, 0.1F, 1.0F};
constexpr float ghost_opacity = 0.35F;
constexpr float cut_away_radius = 0.65F;  // as a fraction of the revealed node's diagonal

// The entities of the named node and its descendants.
Result<std::vector<ecs::Entity>> parts_of(const ShownModel& shown, const LoadedModel& model,
                                          const std::string& name) {
    BOLT_TRY_ASSIGN(const auto nodes, nodes_of(model.model, name));
    std::vector<ecs::Entity> parts;
    const auto& drawables = shown.world.pool<Drawable>();
    for (std::size_t i = 0; i < drawables.size(); ++i)
        if (nodes.contains(drawables.components()[i].node)) parts.push_back(drawables.entities()[i]);
    return parts;
}

Status set_outline(ShownModel& shown, const LoadedModel& model, const std::string& node,
                   const glm::vec4& color) {
    BOLT_TRY_ASSIGN(const auto parts, parts_of(shown, model, node));
    for (const ecs::Entity part : parts) shown.world.add<Outline>(part, color);
    return {};
}

// Lets everything in front of the node fade.
Status reveal(ShownModel& shown, const LoadedModel& model, const std::string& node) {
    BOLT_TRY_ASSIGN(const auto parts, parts_of(shown, model, node));
    for (const ecs::Entity entity : shown.world.pool<Drawable>().entities())
        shown.world.add<Fadable>(entity, true);
    for (const ecs::Entity part : parts) shown.world.add<Fadable>(part, false);
    BOLT_TRY_ASSIGN(const auto box, box_of(shown, model, node));
    if (box.empty())
        return fail(ErrorCode::usage, fmt::format("the node \"{}\" is not drawn", node),
                    "a node with a mesh");
    shown.scene.cut_away = {0.5F * (box.low + box.high), cut_away_radius * glm::distance(box.low, box.high),
                            1.0F};
    return {};
}

}  // namespace

Status outline(ShownModel& shown, const LoadedModel& model, const std::string& node, const glm::vec4& color) {
    BOLT_TRY(set_outline(shown, model, node, color));
    collect_objects(shown.world, shown.scene);
    return {};
}

Result<render::BoundingBox> box_of(const ShownModel& shown, const LoadedModel& model,
                                   const std::string& node) {
    BOLT_TRY_ASSIGN(const auto nodes, nodes_of(model.model, node));
    render::Scene part;
    for (const render::Object& object : shown.scene.objects)
        if (nodes.contains(object.node)) part.objects.push_back(object);
    return render::bounds(part);
}

Status highlight(ShownModel& shown, const LoadedModel& model, const Highlights& highlights) {
    for (const std::string& name : highlights.outlined)
        BOLT_TRY(set_outline(shown, model, name, outline_color));
    for (const std::string& name : highlights.ghosts) {
        BOLT_TRY_ASSIGN(const auto parts, parts_of(shown, model, name));
        for (const ecs::Entity part : parts) shown.world.add<Appearance>(part).opacity = ghost_opacity;
    }
    if (!highlights.revealed.empty()) BOLT_TRY(reveal(shown, model, highlights.revealed));
    collect_objects(shown.world, shown.scene);
    return {};
}

}  // namespace bolt::view
