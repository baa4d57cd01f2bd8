// The systems of a workplace: free functions that move its entities and collect what the renderer draws, once
// a frame.
#pragma once

#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"

namespace bolt::scene {

// The state of tool and hand in a frame. Poses are in the assembly's frame.
struct ToolAndHand {
    Pose tool;                            // limited by obstacles
    bool wrench = false;                  // the wrench is in the hand
    double head_turn = 0.0;               // rad, of a ratchet's head relative to its handle
    tool_models::DisplayReading reading;  // of an electronic torque wrench
    Pose rest;                            // of a wrench that is not in the hand
    bool pinches = false;                 // without a wrench: the fingers are closed on a nut
    Pose fingers;                         // without a wrench: the frame of the hand
    // Without a wrench: the measured pose of the joint hand::palm; none: not measured. The hand is drawn at
    // this pose, except at a nut without a glove, where it is drawn at `fingers`.
    std::optional<Pose> palm;
    bool at_nut = false;                   // a nut is within reach of the fingers
    std::size_t handle_posture_index = 0;  // in Postures::on_handle
    double seconds = 0.0;                  // since the last frame; changes of posture are smoothed over time
    double effort = 0.0;                   // 0 … 1, of the hand's greatest effort (Effort::share)
    double tremor = 0.0;                   // −1 … 1, present deflection of its trembling (Effort::tremor)
    double closed_share = 0.0;             // 0 (open) … 1: the fingers of an empty hand
    // The measured joints of a gloved hand (world::GloveHand::joints); null: no glove.
    const hand::Skeleton* gloved = nullptr;
    // The displayed hand stays out of these solids; null: no solids.
    const collision::CollisionWorld* solids = nullptr;
};

// The parts of placement_system().
void place_fasteners(SceneWorld& world, const servo::Setup& setup);
// The second wrench on its joint: of the twelve directions in which the ring fits, the handle takes the one
// that points away from the middle of all joints. It is no obstacle for the tool in the hand. `corner`: rad
// about the joint's axis, from servo::NutGeometry::e1 to a corner of the held part.
Pose second_wrench_pose(const servo::Setup& setup, std::size_t joint, double corner);
void place_second_wrench(SceneWorld& world, const servo::Setup& setup);
// `tool`: index in servo::Setup::tools of the one to show.
void place_tool(SceneWorld& world, std::size_t tool, const ToolAndHand& state);
void place_hand(SceneWorld& world, const Postures& postures, const ToolAndHand& state);

// The input of placement_system() besides the world.
struct PlacementContext {
    const servo::Setup& setup;
    const Postures& postures;
    Vec3 shoulder;                                      // m, the worker's, in the assembly's frame
    std::size_t handle_posture_index = 0;               // in Postures::on_handle
    double effort = 0.0, tremor = 0.0;                  // 0 … 1 and −1 … 1, as in Effort
    double seconds = 0.0;                               // since the last frame
    const collision::CollisionWorld* solids = nullptr;  // the drawn hand stays out of them; null: none
};

// Moves nuts, wrench and hand to their poses in the components of the simulation, in a lesson and in a film.
void placement_system(SceneWorld& world, const PlacementContext& context);

// Width across flats of the widest nut, m.
double widest_nut(const servo::Setup& setup);

// Displays a transparent wrench (`tool`: its index in servo::Setup::tools) or a transparent hand. `posture`:
// in the frame of the tool, whose pose is `at`.
void show_wrench_ghost(SceneWorld& world, std::size_t tool, const Pose& pose);
void show_hand_ghost(SceneWorld& world, const Pose& at, const hand::Skeleton& posture);
void hide_ghosts(SceneWorld& world);

// Outlines the parts of a joint or of the tool; alpha 0 removes the outline.
void outline_joint(SceneWorld& world, std::size_t joint, const glm::vec4& color);
void outline_tool(SceneWorld& world, const glm::vec4& color);

// The objects that fade in front of a nut. `all`: everything but the nut's own joint. `hand`: only the hand,
// in a larger area.
enum class Occluders : std::uint8_t { all, hand };
void fade_occluders(SceneWorld& world, render::Scene& scene, const servo::Setup& setup, std::size_t joint,
                    Occluders occluders = Occluders::all);

// Fades a drawn forearm that would fill the picture because it is near to the eye (m, assembly frame).
void fade_near_arms(SceneWorld& world, const Vec3& eye);

// A scene without objects, with the environment light and view::key_light().
render::Scene make_lit_scene(const Workplace& workplace, const render::EnvironmentLight& light);

// Destroys the drawable entities, because a GPU loss destroys their models; the state of the simulation
// remains.
void destroy_drawables(SceneWorld& world);

// Writes the Appearance of hand, ghosts, arrows and dial. Call before view::collect_objects().
void appearance_system(SceneWorld& world);

}  // namespace bolt::scene
