// The mechanism of a click-type torque wrench (ISO 6789-1: type II, class A), in series between the hand and
// the wrench's spring. Up to its setting it is a rigid piece; there it trips, and the handle swings on
// against less, until it bottoms and is a rigid piece again: who pulls on puts in more. Let go of it swings
// back, and holds up to its setting anew. Only tightening trips it.
//
//   not swung     T ≤ setting
//   swinging on   T = falls_to · setting + c · speed      back   T = rearms_at · setting + c · speed
//   bottomed      T ≥ rearms_at · setting
//
// c = stiffness · settles: held still, the torque falls with that time constant and does not jump. Between
// its two torques a mechanism that has swung stands, so that swinging to and fro takes energy and never gives
// any.
#pragma once

namespace bolt::joint {

// What it is. The shares and times are ours: the standard is about the setting alone.
struct Click {
    double setting = 0.0;    // N·m at which it trips; 0: it never does
    double swing = 0.0;      // rad that the handle swings before it bottoms; 0: there is no mechanism
    double falls_to = 0.5;   // of the setting, above rearms_at
    double rearms_at = 0.2;  // of the setting, above 0
    double settles = 0.01;   // s

    [[nodiscard]] bool trips() const { return setting > 0.0 && swing > 0.0; }
};

// How it stands after a step.
struct ClickStep {
    double swung = 0.0;    // rad, 0 … swing
    bool clicked = false;  // it tripped in this step
};

}  // namespace bolt::joint
