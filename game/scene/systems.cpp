#include "game/scene/systems.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "game/view/shown_model.hpp"
#include "game/world/world.hpp"

namespace bolt::scene {

namespace {

constexpr float ghost_opacity = 0.4F;
constexpr double cut_radius = 0.9, hand_cut_radius = 3.0;  // in nut widths, for Occluders::all and ::hand
constexpr double forearm = 0.25;                           // m, length
constexpr double near_arm = 0.12, far_arm = 0.24;          // m from the eye: fully faded, and not at all
constexpr float max_fade = 0.85F;
constexpr double fade_begin = 4e-3, fade_end = 12e-3;  // m, penetration of the hand into solids
constexpr float max_pallor = 0.4F;                     // share of the tint at full effort
constexpr glm::vec3 pale_skin{0.95F, 0.80F, 0.74F};
constexpr glm::vec4 ghost_tint{0.2F, 0.75F, 1.0F, 0.7F};

glm::dmat4 matrix(const Pose& pose) {
    return glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.orientation);
}

// The largest distance of a joint between the skeletons, m; not zero if only rotations differ.
double max_distance(const hand::Skeleton& a, const hand::Skeleton& b) {
    double most = a.rotation == b.rotation ? 0.0 : 1e-9;
    for (std::size_t i = 0; i < hand::joint_count; ++i)
        most = std::max(most, glm::distance(a.position[i], b.position[i]));
    return most;
}

std::shared_ptr<const render::Deformation> deform(const SkinnedHand& fingers,
                                                  const hand::Skeleton& skeleton) {
    render::Deformation deformation;
    for (std::size_t i = 0; i < fingers.inverse_bind.size() && i < hand::joint_count; ++i) {
        glm::dmat4 joint = matrix({skeleton.position[i], skeleton.rotation[i]});
        if (i == hand::wrist) joint = glm::scale(joint, Vec3(1.0, 1.0, fingers.clearance.cuff));
        deformation.joints.push_back(glm::mat4(joint) * fingers.inverse_bind[i]);
    }
    return std::make_shared<const render::Deformation>(std::move(deformation));
}

// The frame of an empty hand. Away from nuts a measured hand is drawn where it was measured. At a nut it
// glides to `state.fingers`, the frame in which the fingers are around the nut, because the measured fingers
// hold a controller and are not bent. With a glove the hand stays where it was measured.
Pose frame_of_empty_hand(SkinnedHand& fingers, const ToolAndHand& state, bool first) {
    constexpr double approach = 0.15;  // s, time constant
    if (!state.palm) return state.fingers;
    const double goal = state.at_nut && state.gloved == nullptr ? 1.0 : 0.0;
    const double share = first ? 1.0 : 1.0 - std::exp(-state.seconds / approach);
    fingers.nut_share += share * (goal - fingers.nut_share);
    const Pose drawn_palm{fingers.posture.position[hand::palm], fingers.posture.rotation[hand::palm]};
    const Pose measured = *state.palm * inverse(drawn_palm);
    const Vec3 turn = turn_between(measured.orientation, state.fingers.orientation);
    return {glm::mix(measured.position, state.fingers.position, fingers.nut_share),
            glm::normalize(rotation(fingers.nut_share * turn) * measured.orientation)};
}

// The posture, changed as far as the solids require. A gloved hand is displayed as measured.
hand::Skeleton clear_of_solids(SkinnedHand& fingers, const Postures& postures, const ToolAndHand& state,
                               const Pose& at) {
    if (state.gloved != nullptr || state.solids == nullptr || !fingers.skin) {
        fingers.clearance = {};
        return fingers.posture;
    }
    const HandTask task = state.wrench ? HandTask::on_handle : HandTask::at_nut;
    const Vec3 pivot(state.wrench ? postures.grip_distance : 0.0, 0.0, 0.0);
    advance(fingers.clearance, {state.solids, at, task, pivot, *fingers.skin, fingers.inverse_bind},
            fingers.posture, state.seconds);
    return apply_departure(fingers.posture, fingers.clearance.shown, task, pivot);
}

void outline(SceneWorld& world, ecs::Entity entity, const glm::vec4& color) {
    if (color.w > 0.0F)
        world.add<Outline>(entity, color);
    else
        world.remove<Outline>(entity);
}

}  // namespace

double widest_nut(const servo::Setup& setup) {
    double widest = 0.0;
    for (const auto& nut : setup.nuts) widest = std::max(widest, nut.across_flats);
    return widest;
}

void place_fasteners(SceneWorld& world, const servo::Setup& setup) {
    world.view<const NutPart, Transform>().each([&](const NutPart& nut, Transform& transform) {
        const world::Joint& joint = world::joint_at(world, nut.joint);
        const Pose pose = servo::nut_pose(setup.nuts[nut.joint], joint.angle, joint.common_turn);
        transform.world = glm::mat4(matrix(pose) * nut.nut_from_mesh);
    });
    world.view<const HeldPart, Transform>().each([&](const HeldPart& part, Transform& transform) {
        const servo::NutGeometry& nut = setup.nuts[part.joint];
        const Pose at_rest{nut.seat, Quat(1, 0, 0, 0)};
        const Quat turn =
            glm::angleAxis(-nut.sense * world::joint_at(world, part.joint).common_turn, nut.axis);
        transform.world =
            glm::mat4(matrix(Pose{nut.seat, turn}) * matrix(inverse(at_rest)) * part.assembly_from_mesh);
    });
}

Pose second_wrench_pose(const servo::Setup& setup, std::size_t joint, double corner) {
    Vec3 middle(0.0);
    for (const servo::NutGeometry& nut : setup.nuts)
        middle += nut.seat / static_cast<double>(setup.nuts.size());
    const servo::NutGeometry& nut = setup.nuts[joint];
    const Vec3 outward = nut.seat - middle;
    const double wanted = std::atan2(glm::dot(outward, nut.e2), glm::dot(outward, nut.e1));
    constexpr double fits_every = pi / 6.0;  // a ring with twelve points
    const double angle = corner + fits_every * std::round((wanted - corner) / fits_every);
    const Vec3 handle = std::cos(angle) * nut.e1 + std::sin(angle) * nut.e2;
    const Quat turn = glm::quat_cast(glm::dmat3(handle, glm::cross(-nut.axis, handle), -nut.axis));
    return {nut.seat - nut.held_distance * nut.axis, turn};
}

void place_second_wrench(SceneWorld& world, const servo::Setup& setup) {
    const int joint = world.only<world::ToolState>().second_wrench;
    std::optional<double> corner;  // of the held part; none: it needs no second wrench
    for (const HeldPart& part : world.pool<HeldPart>().components())
        if (static_cast<int>(part.joint) == joint)
            corner =
                part.corner - setup.nuts[part.joint].sense * world::joint_at(world, part.joint).common_turn;
    world.view<const SecondWrenchPart, Transform, Appearance>().each(
        [&](const SecondWrenchPart& part, Transform& transform, Appearance& appearance) {
            const auto index = static_cast<std::size_t>(std::max(joint, 0));
            appearance.hidden = !corner || setup.nuts[index].held_across_flats != part.across_flats;
            if (appearance.hidden) return;
            const Pose pose = second_wrench_pose(setup, index, *corner);
            transform.world = glm::mat4(matrix(pose) * part.tool_from_mesh);
        });
}

void place_tool(SceneWorld& world, std::size_t tool, const ToolAndHand& state) {
    const glm::dmat4 pose = matrix(state.wrench ? state.tool : state.rest);
    const glm::dmat4 head = glm::rotate(pose, state.head_turn, Vec3(0.0, 0.0, 1.0));
    world.view<const ToolPart, Transform>().each(
        [&](ecs::Entity entity, const ToolPart& part, Transform& transform) {
            transform.world = glm::mat4((part.in_head ? head : pose) * part.tool_from_mesh);
            Appearance* appearance = world.find<Appearance>(entity);
            const bool off = part.display && !tool_models::is_on(*part.display, state.reading);
            const bool hidden = part.tool != tool || off;
            if (appearance == nullptr && hidden) appearance = &world.add<Appearance>(entity);
            if (appearance != nullptr) appearance->hidden = hidden;
        });
}

void place_hand(SceneWorld& world, const Postures& postures, const ToolAndHand& state) {
    constexpr double change = 0.07;        // s, time constant of a change of posture
    constexpr double max_tremor = 1.2e-3;  // m
    const hand::Skeleton goal =
        state.gloved != nullptr ? *state.gloved
        : state.wrench          ? handle_posture(postures, state.handle_posture_index, state.effort)
        : state.pinches         ? pinch_posture(postures, state.effort)
                                : interpolate(postures.open, postures.on_nut, state.closed_share);
    world.view<SkinnedHand, Transform>().each(
        [&](ecs::Entity entity, SkinnedHand& fingers, Transform& transform) {
            if (world.find<GhostPart>(entity) != nullptr) return;
            fingers.effort = static_cast<float>(state.effort);
            const bool first = !fingers.deformation;
            const double far = first ? 1.0 : max_distance(fingers.posture, goal);
            const bool arrived = first || far < 2e-4 || state.gloved != nullptr;
            fingers.posture =
                arrived ? goal : interpolate(fingers.posture, goal, 1.0 - std::exp(-state.seconds / change));
            Pose at = state.wrench ? state.tool : frame_of_empty_hand(fingers, state, first);
            // The tremor is along the pull.
            at.position += at.orientation * Vec3(0.0, max_tremor * state.tremor, 0.0);
            transform.world = glm::mat4(matrix(at));
            const double cuff = fingers.clearance.cuff;
            const hand::Skeleton shown = clear_of_solids(fingers, postures, state, at);
            if (!first && cuff == fingers.clearance.cuff && max_distance(fingers.shown, shown) == 0.0) return;
            fingers.shown = shown;
            fingers.deformation = deform(fingers, shown);
        });
}

void placement_system(SceneWorld& world, const PlacementContext& context) {
    constexpr double wrist_share = 0.3;  // fraction of the fingers' twist that the wrist shows
    const auto& hands = world.pool<world::WorkingHand>();
    const world::WorkingHand& hand = hands.components().front();
    const world::GloveHand* glove = world.find<world::GloveHand>(hands.entities().front());
    ToolAndHand held;
    held.tool = hand.wrench ? world.only<world::ConstrainedTool>().pose : hand.pose;
    held.wrench = hand.wrench;
    const world::ToolState& tool = world.only<world::ToolState>();
    held.head_turn = tool.head_turn;
    held.reading = {tool.displayed, tool.target == world::TargetState::reached,
                    tool.target == world::TargetState::exceeded};
    held.rest = hand.rest;
    held.pinches = hand.pinches;
    held.closed_share = hand.closed_share;
    held.palm = hand.palm;
    held.at_nut = hand.nut.has_value();
    // The wrist is drawn towards this point. With a measured hand it is on the side of its palm, because at a
    // nut the fingers are bent.
    const Vec3 towards =
        held.palm ? hand.pose.position - held.palm->orientation * Vec3(0.0, 1.0, 0.0) : context.shoulder;
    const double sense = hand.nut ? context.setup.nuts[*hand.nut].sense : 1.0;
    held.fingers = glove != nullptr && !hand.palm
                       ? hand.rest
                       : frame_towards(hand.pose, towards, -sense * wrist_share * hand.twisted);
    held.handle_posture_index = context.handle_posture_index;
    held.seconds = context.seconds;
    held.effort = context.effort;
    held.tremor = context.tremor;
    held.gloved = glove != nullptr ? &glove->joints : nullptr;
    held.solids = context.solids;
    place_fasteners(world, context.setup);
    place_second_wrench(world, context.setup);
    place_tool(world, context.setup.tool, held);
    place_hand(world, context.postures, held);
}

void show_wrench_ghost(SceneWorld& world, std::size_t tool, const Pose& pose) {
    const glm::dmat4 at = matrix(pose);
    world.view<GhostPart, Transform>().each([&](ecs::Entity entity, GhostPart& ghost, Transform& transform) {
        if (world.find<SkinnedHand>(entity) != nullptr || ghost.tool != tool) return;
        ghost.shown = true;
        transform.world = glm::mat4(at * ghost.tool_from_mesh);
    });
}

void show_hand_ghost(SceneWorld& world, const Pose& at, const hand::Skeleton& posture) {
    world.view<GhostPart, SkinnedHand, Transform>().each(
        [&](GhostPart& ghost, SkinnedHand& fingers, Transform& transform) {
            ghost.shown = true;
            transform.world = glm::mat4(matrix(at));
            if (fingers.deformation && max_distance(fingers.shown, posture) == 0.0) return;
            fingers.shown = posture;
            fingers.deformation = deform(fingers, posture);
        });
}

void hide_ghosts(SceneWorld& world) {
    world.view<GhostPart>().each([](GhostPart& ghost) { ghost.shown = false; });
}

void outline_joint(SceneWorld& world, std::size_t joint, const glm::vec4& color) {
    world.view<const JointPart>().each([&](ecs::Entity entity, const JointPart& part) {
        if (part.joint == joint) outline(world, entity, color);
    });
}

void outline_tool(SceneWorld& world, const glm::vec4& color) {
    world.view<const ToolPart>().each(
        [&](ecs::Entity entity, const ToolPart&) { outline(world, entity, color); });
}

void fade_occluders(SceneWorld& world, render::Scene& scene, const servo::Setup& setup, std::size_t joint,
                    Occluders occluders) {
    const servo::NutGeometry& nut = setup.nuts[joint];
    const bool all = occluders == Occluders::all;
    const double radius = all ? cut_radius : hand_cut_radius;
    scene.cut_away = {glm::vec3(world::nut_centre(world, setup, joint)),
                      static_cast<float>(radius * nut.across_flats), 1.0F};
    world.view<Fadable>().each([&](Fadable& fadable) { fadable.fades = all; });
    world.view<const JointPart, Fadable>().each(
        [&](const JointPart& part, Fadable& fadable) { fadable.fades = all && part.joint != joint; });
    world.view<const SkinnedHand, Fadable>().each(
        [](const SkinnedHand&, Fadable& fadable) { fadable.fades = true; });
}

void fade_near_arms(SceneWorld& world, const Vec3& eye) {
    world.view<SkinnedHand, const Transform>().each([&](SkinnedHand& fingers, const Transform& transform) {
        const glm::dmat4 at(transform.world);
        const Vec3 wrist(at * glm::dvec4(fingers.shown.position[hand::wrist], 1.0));
        const Vec3 arm(glm::dmat3(at) * (fingers.shown.rotation[hand::wrist] * Vec3(0.0, 0.0, forearm)));
        const double along = std::clamp(glm::dot(eye - wrist, arm) / (forearm * forearm), 0.0, 1.0);
        const double off = glm::distance(eye, wrist + along * arm);
        fingers.nearness = static_cast<float>(1.0 - glm::smoothstep(near_arm, far_arm, off));
    });
}

render::Scene make_lit_scene(const Workplace& workplace, const render::EnvironmentLight& light) {
    render::Scene scene;
    scene.environment = &light;
    scene.lights.push_back(view::key_light());
    scene.background = {0.10F, 0.11F, 0.12F, 1.0F};
    scene.occlusion_radius = 0.04F * glm::distance(workplace.workpiece.low, workplace.workpiece.high);
    return scene;
}

void destroy_drawables(SceneWorld& world) {
    world.view<const Drawable>().each([&](ecs::Entity entity, const Drawable&) { world.destroy(entity); });
}

void appearance_system(SceneWorld& world) {
    world.view<const SkinnedHand, Drawable>().each(
        [&](ecs::Entity entity, const SkinnedHand& fingers, Drawable& drawn) {
            drawn.deformation = fingers.deformation;
            const double intrusion = glm::smoothstep(fade_begin, fade_end, fingers.clearance.depth);
            const float fade = std::max(fingers.nearness, static_cast<float>(intrusion));
            // Never zero, because an object without a tint needs another pipeline, whose compilation would
            // delay a pull.
            const float pallor = std::max(1e-3F, max_pallor * fingers.effort);
            world.add<Appearance>(entity, glm::vec4(pale_skin, pallor), 1.0F - max_fade * fade);
        });
    world.view<const GhostPart>().each([&](ecs::Entity entity, const GhostPart& ghost) {
        const bool hand = world.find<SkinnedHand>(entity) != nullptr;
        const float opacity = hand ? world.get<Appearance>(entity).opacity : 1.0F;
        world.add<Appearance>(entity, ghost_tint, ghost_opacity * opacity, !ghost.shown);
    });
    world.view<const ArrowMarker>().each([&](ecs::Entity entity, const ArrowMarker& marker) {
        world.add<Appearance>(entity, glm::vec4(glm::vec3(marker.color), 1.0F), 1.0F, !marker.shown);
    });
    world.view<const DialMarker>().each([&](ecs::Entity entity, const DialMarker& marker) {
        world.add<Appearance>(entity, glm::vec4(glm::vec3(marker.color), 1.0F), 1.0F, !marker.shown);
    });
}

}  // namespace bolt::scene
