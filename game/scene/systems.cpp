#include "game/scene/systems.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace bolt::scene {

namespace {

glm::dmat4 matrix(const Pose& pose) {
    return glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.orientation);
}

void outline(World& world, ecs::Entity entity, const glm::vec4& color) {
    if (color.w > 0.0F)
        world.add<Outlined>(entity, color);
    else
        world.remove<Outlined>(entity);
}

}  // namespace

void place_nuts(World& world, const servo::Setup& setup, std::span<const joint::JointState> joints) {
    world.view<const Nut, Placement>().each([&](const Nut& nut, Placement& placement) {
        const Pose pose = servo::nut_pose(setup.nuts[nut.joint], joints[nut.joint].nut.angle);
        placement.world = glm::mat4(matrix(pose) * nut.own_from_mesh);
    });
}

void place_tool(World& world, const Held& held) {
    const glm::dmat4 tool = matrix(held.wrench ? held.tool : held.rest);
    world.view<const OnTool, Placement>().each([&](const OnTool& on, Placement& placement) {
        placement.world = glm::mat4(tool * on.tool_from_mesh);
    });
}

void place_hand(World& world, const Postures& postures, const Held& held) {
    const hand::Skeleton shown =
        held.wrench ? postures.on_handle : between(postures.open, postures.on_nut, held.pinch);
    world.view<Fingers, Placement>().each([&](Fingers& fingers, Placement& placement) {
        placement.world = glm::mat4(matrix(held.tool));
        const bool bent = fingers.deformation && fingers.shown.position == shown.position &&
                          fingers.shown.rotation == shown.rotation;
        if (bent) return;
        fingers.shown = shown;
        render::Deformation deformation;
        for (std::size_t i = 0; i < fingers.inverse_bind.size() && i < hand::joint_count; ++i)
            deformation.joints.push_back(glm::mat4(matrix({shown.position[i], shown.rotation[i]})) *
                                         fingers.inverse_bind[i]);
        fingers.deformation = std::make_shared<const render::Deformation>(std::move(deformation));
    });
}

void outline_joint(World& world, std::size_t joint, const glm::vec4& color) {
    world.view<const OfJoint>().each([&](ecs::Entity entity, const OfJoint& of) {
        if (of.joint == joint) outline(world, entity, color);
    });
}

void outline_tool(World& world, const glm::vec4& color) {
    world.view<const OnTool>().each(
        [&](ecs::Entity entity, const OnTool&) { outline(world, entity, color); });
}

void present(World& world, render::Scene& scene) {
    scene.objects.clear();
    world.view<const Drawn, const Placement>().each(
        [&](ecs::Entity entity, const Drawn& drawn, const Placement& placement) {
            render::Object object;
            object.model = drawn.model;
            object.mesh = drawn.mesh;
            object.node = drawn.node;
            object.moves = drawn.moves;
            object.world = placement.world;
            if (const Fingers* fingers = world.find<Fingers>(entity))
                object.deformation = fingers->deformation;
            if (const Outlined* line = world.find<Outlined>(entity)) object.outline = line->color;
            if (const CanFade* fade = world.find<CanFade>(entity)) object.cut = fade->fades;
            if (const Ghost* ghost = world.find<Ghost>(entity)) {
                object.opacity = ghost->opacity;
                object.tint = ghost->tint;
            }
            scene.objects.push_back(object);
        });
}

}  // namespace bolt::scene
