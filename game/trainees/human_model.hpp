// How a hand gives way to what it feels: a mass, a damper and a spring between where it means to be and where
// it is (Hogan, Impedance control, ASME J. Dyn. Syst. Meas. Control 107 (1985) 1). What a hand does by itself
// it does without lag, as a practised reach is; only forces drive it away from there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainees {

// Of a hand that holds a wrench. Chosen, not measured: within the ranges that tests/stability tries the
// device with, damped at 0.7 of critical. The greatest force is meant for somebody who reaches and does not
// lean.
struct Impedance {
    double mass = 0.5;               // kg
    double damping = 17.0;           // N·s/m
    double stiffness = 300.0;        // N/m
    double force = 6.0;              // N, what its spring pushes at most
    double inertia = 5e-3;           // kg·m²
    double angular_damping = 0.14;   // N·m·s/rad
    double angular_stiffness = 2.0;  // N·m/rad
    double torque = 0.6;             // N·m
};

struct Arm {
    Vec3 offset{0.0}, velocity{0.0};  // m, m/s: from where the hand means to be
    Vec3 turn{0.0}, rate{0.0};        // rad, rad/s, as rotation vectors
};

// The hand is at `pose` and means to be at `meant`: nothing moves by that.
void take_up(Arm& arm, const Pose& pose, const Pose& meant);

// One tick: where the hand is. `grips`: it has hold of a nut, puts in what it feels and gives way to nothing;
// what it was away from its meaning fades.
Pose follow(const Impedance& impedance, Arm& arm, const Pose& meant, const force::OutputCommand& felt,
            bool grips, double dt);

// A trainee's perception of the nut in its hand, delayed by a reaction time: the torque that the device
// renders, how that torque grows while the wrench turns, and the nut's motion. A trainee has no other access
// to the joint.

// Returns the joint's torque (N·m about the bolt's axis, tightening positive) as the device's output conveys
// it, with the device's scale divided out. `handle`: unit, from the bolt to the grip.
double felt_torque(const force::TorqueRendering& rendering, const servo::NutGeometry& nut, const Vec3& handle,
                   const force::OutputCommand& output);

struct Feeling {
    double torque = 0.0;       // N·m, tightening positive
    double torque_rate = 0.0;  // N·m/s, smoothed over 30 ms
    bool yields = false;       // the resistance no longer grows as it did
    double nut_speed = 0.0;    // rad/s, seen
    bool clicked = false;      // the torque wrench has given way
};

class Nerves {
  public:
    // `stiffness`: of wrench and wrists, N·m/rad; their deflection is subtracted from the hand's turning.
    Nerves(double reaction, double dt, double stiffness);

    // One tick: takes the current values and returns those of a reaction time ago. `turned`: rad that the
    // hand has turned the wrench; `on`: it has hold of a nut.
    const Feeling& feel(double torque, double turned, double nut_speed, bool on, bool clicked = false);

  private:
    struct Moment {
        double torque = 0.0, turned = 0.0, nut_speed = 0.0;
        bool on = false, clicked = false;
    };
    void follow_slope(const Moment& late);

    double dt_, stiffness_;
    std::vector<Moment> line_;
    std::size_t at_ = 0;
    Feeling now_;
    Moment mark_;            // where the slope that is being felt began, `turned` that of the nut
    double steepest_ = 0.0;  // N·m/rad, since it took hold
    double hand_ = 0.0, nut_ = 0.0, hand_rate_ = 0.0, nut_rate_ = 0.0;  // rad, and rad a tick, smoothed
};

// Simulated trainees: how well and how fast a person of this kind works. Ours, plausible rather than
// measured; each number is a thing that an instructor could watch.

struct Profile {
    std::string_view name;
    double reach_time;      // s, from one joint to the next
    double placing_time;    // s, to lower the tool onto the nut
    double position_noise;  // m, standard deviation of where the tool is placed
    double angle_noise;     // rad, of how the jaw is turned before it slides on
    double tremor;          // m, amplitude of physiological tremor (8–12 Hz)
    double tremor_torsion;  // rad, about the bolt while pulling
    double pull_speed;      // rad/s of the handle on a free nut
    double load_rate;       // 1/s, growth of the torque far from the goal, as a share of what is missing
    double final_rate;      // 1/s, growth at the goal, as a share of the goal
    double spin_speed;      // rad/s of the fingers
    double stroke;          // rad, longest pull before re-gripping
    double reaction;        // s between feeling a torque and answering it
    double torque_bias;     // relative, where it means to stop above the target
    double torque_noise;    // relative, standard deviation of one stop
    double anticipation;    // 0…1, how much of its own reaction time it allows for
    double feels_yield;     // chance of noticing that a bolt begins to yield
    double content;         // 0…1, how much of nut and jaw it wants to see before it goes there
    double pause;           // s of hesitation before a step, on average
    double wrong_joint;     // chance of going to another joint than the due one
    double stops_early;     // chance of letting go well below the target
    double overdoes;        // chance of pulling on well past it
    Impedance hand{};       // how it gives way
};

// "expert", "novice", "clumsy"; the error names the nearest.
Result<Profile> find_profile(std::string_view name);
std::vector<std::string> profile_names();

}  // namespace bolt::trainees
