// All joints of an assembly under one law, stepped together.
#pragma once

#include <span>
#include <vector>

#include "haptics/joint/flange.hpp"
#include "haptics/joint/mechanistic.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::joint {

struct GroupParameters {
    Law law = Law::mechanistic;
    std::vector<MechanisticParameters> joints;  // mechanistic
    PublishedParameters published;              // published: the same for all, and every joint is alone
    CouplingMatrix coupling;                    // mechanistic; empty: not coupled
};

struct JointState {
    NutMotion nut;
    double torque = 0.0;  // N·m that the wrench or the fingers give now, tightening positive
    double clamp = 0.0;   // N
    // 0…1, how much of what friction has more at rest than sliding is there: wears off as the nut turns.
    double breakaway = 0.0;
    Stage stage = Stage::navigation;
    Condition condition = Condition::sound;
    MechanisticState mechanistic;
    PublishedState published;
};

// Derives the joints (seeded scatter: one stream a joint) and couples them through the flange if there is
// one.
GroupParameters make_group(std::span<const JointDesign> designs, const FlangePlate* flange,
                           std::uint64_t seed);
GroupParameters make_published_group(const PublishedParameters& parameters);

std::vector<JointState> initial_state(const GroupParameters& group, std::size_t joints);

Resistance resistance(const GroupParameters& group, std::size_t joint, const JointState& state);

// One step of dt: the nut `driven` (or none: −1) under its handle, then every joint's clamp force. The
// group's forces minimise a strictly convex energy; each step is one sweep of exact minimisation joint by
// joint from the last solution, so it never diverges, and what it leaves open is closed by the next steps.
// Returned: the handle's torque wrench.
ClickStep step_group(const GroupParameters& group, std::span<JointState> joints, int driven,
                     const Handle& handle, double dt);

// Turns one nut to an angle as a machine would, kinematically, `share` the friction's direction (+1 on, −1
// off).
void turn_nut(const GroupParameters& group, std::span<JointState> joints, std::size_t joint, double angle,
              double share, double dt);

}  // namespace bolt::joint
