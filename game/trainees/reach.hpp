// The reach of a simulated hand: the choice of the nut and of the path, and the reaction to an obstacle.
#pragma once

#include "game/trainees/trainee_state.hpp"

namespace bolt::trainees {

// m above the nut before lowering and after lifting: past the bolt's end, also where a force of a few newtons
// draws the hand down.
constexpr double hover = 0.035;

// Chooses the due step and the intent for it, and starts the reach.
void decide(Mind& mind);

// Chooses the handle angle so that the stroke is centred on the trainee's side.
void choose_grip_angle(Mind& mind);

// Starts the reach to the nut, with the head where most of the nut is visible.
void set_off(Mind& mind);

// At the end of a movement: starts the movement to the next station, if there is one, and returns whether.
bool goes_on(Mind& mind, Phase reaching);

void lift_off(Mind& mind, const Pose& pose, double seconds);

// The jaw is on the nut: the wrench's pose becomes the hand's intended pose.
void take_hold(Mind& mind);

// Takes a wrench that is caught on an obstacle off it; the next path is higher.
void notice_caught(Mind& mind, const Pose& meant, const Pose& wrench);

}  // namespace bolt::trainees
