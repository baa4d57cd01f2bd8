// A simulated hand on its way: to which nut it goes, from where, and what it does when it is stopped.
#pragma once

#include "game/operators/mind.hpp"

namespace bolt::operators {

// m above the nut before lowering and after lifting: past the bolt's end, also where a force of a few newtons
// draws the hand down.
constexpr double hover = 0.035;

// Which step is due, how this person will go about it, and off the hand goes.
void decide(Mind& mind);

// The handle ends its stroke about as far beyond the trainee's side as it began before it.
void choose_grip_angle(Mind& mind);

// The hand sets off to the nut, with the head where it sees it best.
void set_off(Mind& mind);

// At the end of a way: whether it goes on to another station.
bool goes_on(Mind& mind, Phase reaching);

void lift_off(Mind& mind, const Pose& pose, double seconds);

// The jaw is on the nut: where the wrench is, there the hand means it to be from now on.
void take_hold(Mind& mind);

// A wrench that is caught on something is taken off it, and the next way goes higher.
void notice_caught(Mind& mind, const Pose& meant, const Pose& wrench);

}  // namespace bolt::operators
