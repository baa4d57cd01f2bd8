// What moves and draws a workplace, a frame at a time: free functions over its entities.
#pragma once

#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"

namespace bolt::scene {

// Nuts, wrench and hand to where the servo has them. `tool`: where obstacles let it be; `rest`: where the
// wrench lies while it is not in the hand.
struct Held {
    Pose tool;
    bool wrench = false;  // in the hand
    Pose rest;
    bool pinches = false;  // fingers are closed on a nut, without a wrench
    Pose fingers;          // what they are shown in, without a wrench
    std::size_t grip = 0;  // of Postures::on_handle
    double seconds = 0.0;  // since the last frame: a hand changes its posture in no time, but not at once
    double strain = 0.0;   // 0 … 1, of the hand (strain.hpp)
    double tremor = 0.0;   // −1 … 1, likewise
    // Of a hand in a glove, in the frame of the wrench, in the hand or where it lies.
    const hand::Skeleton* gloved = nullptr;
    // The drawn hand stays out of these; null: there are none.
    const collision::World* solids = nullptr;
};
void place_nuts(World& world, const servo::Setup& setup);
void place_tool(World& world, const Held& held);
// m across flats of the widest nut.
double widest_nut(const servo::Setup& setup);
void place_hand(World& world, const Postures& postures, const Held& held);

// The ghosts of the wrench, with its jaw there, and of a hand bent like this in the frame of the tool.
void show_ghost(World& world, const Pose& tool);
void show_hand_ghost(World& world, const Pose& tool, const hand::Skeleton& bent);
void hide_ghosts(World& world);

// Lines around what belongs to a joint; none for a colour without alpha.
void outline_joint(World& world, std::size_t joint, const glm::vec4& color);
void outline_tool(World& world, const glm::vec4& color);

// What hides a nut fades: the machine, other joints and the hand, or only a hand that waits, and more of
// that.
enum class Hides : std::uint8_t { all, hand };
void keep_in_sight(World& world, render::Scene& scene, const servo::Setup& setup, std::size_t joint,
                   Hides hides = Hides::all);

// An arm so near to the eye (m, the assembly's frame) that it would fill the picture is seen through.
void thin_near_arms(World& world, const Vec3& eye);

// A scene without anything in it yet, in the workshop's light and a lamp's over the left shoulder.
render::Scene lit(const Workplace& place, const render::EnvironmentLight& light);

// Destroys what is drawn, because its models are lost with the GPU; the state of the work stays.
void remove_pictures(World& world);

// Everything there is, as the renderer takes it; lights, labels and background are left as they are.
void present(World& world, render::Scene& scene);

}  // namespace bolt::scene
