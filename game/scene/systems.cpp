#include "game/scene/systems.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "game/world/world.hpp"

namespace bolt::scene {

namespace {

constexpr float ghost_opacity = 0.4F, most_pale = 0.4F;
constexpr double around_work = 0.9, around_waiting = 3.0;  // of a nut's width, around its middle, kept free
constexpr double forearm = 0.25, nearest_arm = 0.12, clear_arm = 0.24;  // m: of it; thinned, and not at all
constexpr float most_thinned = 0.85F;
constexpr double fades_from = 4e-3, fades_to = 12e-3;  // m that the hand is deep in something solid
constexpr glm::vec3 pale{0.95F, 0.80F, 0.74F};
constexpr glm::vec4 ghost_tint{0.2F, 0.75F, 1.0F, 0.7F};

glm::dmat4 matrix(const Pose& pose) {
    return glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.orientation);
}

// m, of a joint from where it is to be.
double furthest(const hand::Skeleton& a, const hand::Skeleton& b) {
    double most = a.rotation == b.rotation ? 0.0 : 1e-9;
    for (std::size_t i = 0; i < hand::joint_count; ++i)
        most = std::max(most, glm::distance(a.position[i], b.position[i]));
    return most;
}

std::shared_ptr<const render::Deformation> bend(const Fingers& fingers, const hand::Skeleton& to) {
    render::Deformation deformation;
    for (std::size_t i = 0; i < fingers.inverse_bind.size() && i < hand::joint_count; ++i) {
        glm::dmat4 joint = matrix({to.position[i], to.rotation[i]});
        if (i == hand::wrist) joint = glm::scale(joint, Vec3(1.0, 1.0, fingers.clearance.cuff));
        deformation.joints.push_back(glm::mat4(joint) * fingers.inverse_bind[i]);
    }
    return std::make_shared<const render::Deformation>(std::move(deformation));
}

// The posture, departed from as far as the solids demand. A gloved hand is drawn as it is measured.
hand::Skeleton clear_of_solids(Fingers& fingers, const Postures& postures, const Held& held, const Pose& at) {
    if (held.gloved != nullptr || held.solids == nullptr || !fingers.skin) {
        fingers.clearance = {};
        return fingers.posture;
    }
    const HandTask task = held.wrench ? HandTask::on_handle : HandTask::at_nut;
    const Vec3 pivot(held.wrench ? postures.grip_at : 0.0, 0.0, 0.0);
    advance(fingers.clearance, {held.solids, at, task, pivot, *fingers.skin, fingers.inverse_bind},
            fingers.posture, held.seconds);
    return departed(fingers.posture, fingers.clearance.shown, task, pivot);
}

void outline(World& world, ecs::Entity entity, const glm::vec4& color) {
    if (color.w > 0.0F)
        world.add<Outlined>(entity, color);
    else
        world.remove<Outlined>(entity);
}

}  // namespace

double widest_nut(const servo::Setup& setup) {
    double widest = 0.0;
    for (const auto& nut : setup.nuts) widest = std::max(widest, nut.across_flats);
    return widest;
}

void place_nuts(World& world, const servo::Setup& setup) {
    world.view<const Nut, Placement>().each([&](const Nut& nut, Placement& placement) {
        const Pose pose = servo::nut_pose(setup.nuts[nut.joint], world::joint_at(world, nut.joint).angle);
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
    constexpr double change = 0.07;             // s in which most of it is done
    constexpr double furthest_tremor = 1.2e-3;  // m
    const hand::Skeleton goal = held.gloved != nullptr ? *held.gloved
                                : held.wrench          ? holding(postures, held.grip, held.strain)
                                : held.pinches         ? pinching(postures, held.strain)
                                                       : postures.open;
    world.view<Fingers, Placement>().each([&](ecs::Entity entity, Fingers& fingers, Placement& placement) {
        if (world.find<Ghost>(entity) != nullptr) return;
        Pose at = held.wrench ? held.tool : held.fingers;
        // Along the way of the pull.
        at.position += at.orientation * Vec3(0.0, furthest_tremor * held.tremor, 0.0);
        placement.world = glm::mat4(matrix(at));
        fingers.strain = static_cast<float>(held.strain);
        const bool first = !fingers.deformation;
        const double far = first ? 1.0 : furthest(fingers.posture, goal);
        const bool there = first || far < 2e-4 || held.gloved != nullptr;
        fingers.posture =
            there ? goal : between(fingers.posture, goal, 1.0 - std::exp(-held.seconds / change));
        const double cuff = fingers.clearance.cuff;
        const hand::Skeleton shown = clear_of_solids(fingers, postures, held, at);
        if (!first && cuff == fingers.clearance.cuff && furthest(fingers.shown, shown) == 0.0) return;
        fingers.shown = shown;
        fingers.deformation = bend(fingers, shown);
    });
}

void show_ghost(World& world, const Pose& tool) {
    const glm::dmat4 at = matrix(tool);
    world.view<Ghost, Placement>().each([&](ecs::Entity entity, Ghost& ghost, Placement& placement) {
        if (world.find<Fingers>(entity) != nullptr) return;
        ghost.shown = true;
        placement.world = glm::mat4(at * ghost.tool_from_mesh);
    });
}

void show_hand_ghost(World& world, const Pose& tool, const hand::Skeleton& bent) {
    world.view<Ghost, Fingers, Placement>().each([&](Ghost& ghost, Fingers& fingers, Placement& placement) {
        ghost.shown = true;
        placement.world = glm::mat4(matrix(tool));
        if (fingers.deformation && furthest(fingers.shown, bent) == 0.0) return;
        fingers.shown = bent;
        fingers.deformation = bend(fingers, bent);
    });
}

void hide_ghosts(World& world) {
    world.view<Ghost>().each([](Ghost& ghost) { ghost.shown = false; });
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

void keep_in_sight(World& world, render::Scene& scene, const servo::Setup& setup, std::size_t joint,
                   Hides hides) {
    const servo::NutGeometry& nut = setup.nuts[joint];
    const bool all = hides == Hides::all;
    const double kept_free = all ? around_work : around_waiting;
    scene.cut_away = {glm::vec3(world::nut_centre(world, setup, joint)),
                      static_cast<float>(kept_free * nut.across_flats), 1.0F};
    world.view<CanFade>().each([&](CanFade& can) { can.fades = all; });
    world.view<const OfJoint, CanFade>().each(
        [&](const OfJoint& of, CanFade& can) { can.fades = all && of.joint != joint; });
    world.view<const Fingers, CanFade>().each([](const Fingers&, CanFade& can) { can.fades = true; });
}

void thin_near_arms(World& world, const Vec3& eye) {
    world.view<Fingers, const Placement>().each([&](Fingers& fingers, const Placement& placement) {
        const glm::dmat4 at(placement.world);
        const Vec3 wrist(at * glm::dvec4(fingers.shown.position[hand::wrist], 1.0));
        const Vec3 arm(glm::dmat3(at) * (fingers.shown.rotation[hand::wrist] * Vec3(0.0, 0.0, forearm)));
        const double along = std::clamp(glm::dot(eye - wrist, arm) / (forearm * forearm), 0.0, 1.0);
        const double off = glm::distance(eye, wrist + along * arm);
        fingers.too_near = static_cast<float>(1.0 - glm::smoothstep(nearest_arm, clear_arm, off));
    });
}

render::Scene lit(const Workplace& place, const render::EnvironmentLight& light) {
    render::Scene scene;
    scene.environment = &light;
    render::SceneLight key;
    key.light.direction = glm::vec4(glm::normalize(glm::vec3(0.45F, -1.0F, -0.55F)), 0.0F);
    key.light.color = glm::vec4(1.6F, 1.55F, 1.5F, 0.0F);
    key.casts_shadow = true;
    scene.lights.push_back(key);
    scene.background = {0.10F, 0.11F, 0.12F, 1.0F};
    scene.occlusion_radius = 0.04F * glm::distance(place.machine.low, place.machine.high);
    return scene;
}

void remove_pictures(World& world) {
    world.view<const Drawn>().each([&](ecs::Entity entity, const Drawn&) { world.destroy(entity); });
}

void present(World& world, render::Scene& scene) {
    scene.objects.clear();
    world.view<const Drawn, const Placement>().each([&](ecs::Entity entity, const Drawn& drawn,
                                                        const Placement& placement) {
        render::Object object;
        object.model = drawn.model;
        object.mesh = drawn.mesh;
        object.node = drawn.node;
        object.moves = drawn.moves;
        object.world = placement.world;
        if (const Fingers* fingers = world.find<Fingers>(entity)) {
            object.deformation = fingers->deformation;
            // Never quite none: what has none is drawn by other shaders, made in the middle of a pull.
            object.tint = glm::vec4(pale, std::max(1e-3F, most_pale * fingers->strain));
            const double intrudes = glm::smoothstep(fades_from, fades_to, fingers->clearance.depth);
            object.opacity = 1.0F - most_thinned * std::max(fingers->too_near, static_cast<float>(intrudes));
        }
        if (const Outlined* line = world.find<Outlined>(entity)) object.outline = line->color;
        if (const CanFade* fade = world.find<CanFade>(entity)) object.cut = fade->fades;
        if (const Ghost* ghost = world.find<Ghost>(entity)) {
            if (!ghost->shown) return;
            object.opacity *= ghost_opacity;

            object.tint = ghost_tint;
        }
        if (const Pointer* pointer = world.find<Pointer>(entity)) {
            if (!pointer->shown) return;
            object.tint = glm::vec4(glm::vec3(pointer->color), 1.0F);
        }
        scene.objects.push_back(object);
    });
}

}  // namespace bolt::scene
