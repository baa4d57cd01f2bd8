// Model of a simulated trainee as a person: the impedance of the hand, delayed perception of the nut, and the
// profiles of skill ("expert", "novice", "clumsy").
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainees {

// A hand that holds a wrench gives way to a force as a mass, a damper and a spring between its intended and
// its actual pose (Hogan, Impedance control, ASME J. Dyn. Syst. Meas. Control 107 (1985) 1). The values are
// chosen, not measured: they lie within the ranges of tests/stability and damp at 0.7 of critical. The force
// limit is that of a person who reaches without leaning on the wrench.
struct Impedance {
    double mass = 0.5;               // kg
    double damping = 17.0;           // N·s/m
    double stiffness = 300.0;        // N/m
    double max_force = 6.0;          // N, limit of the spring's force
    double inertia = 5e-3;           // kg·m²
    double angular_damping = 0.14;   // N·m·s/rad
    double angular_stiffness = 2.0;  // N·m/rad
    double max_torque = 0.6;         // N·m, limit of the spring's torque
};

// Deviation of the hand's actual pose from its intended pose.
struct HandDeflection {
    Vec3 offset{0.0}, velocity{0.0};  // m, m/s
    Vec3 turn{0.0}, rate{0.0};        // rad, rad/s, rotation vectors
};

// Sets the deflection so that the hand stays at `pose` when its intended pose becomes `intended`. The
// velocities become 0.
void reset_deflection(HandDeflection& deflection, const Pose& pose, const Pose& intended);

// Advances the deflection by one tick and returns the hand's actual pose. The intended motion itself has no
// lag, as in a practised reach; only `felt`, the device's output, deflects the hand. If `holds_nut` is true
// the hand does not give way to the output, and the deflection fades.
Pose step_deflection(const Impedance& impedance, HandDeflection& deflection, const Pose& intended,
                     const force::OutputCommand& felt, bool holds_nut, double dt);

// Returns the joint's torque (N·m about the bolt's axis, tightening positive) as the device's output conveys
// it, with the device's scale divided out. `handle`: unit, from the bolt to the grip.
double felt_torque(const force::TorqueRendering& rendering, const servo::NutGeometry& nut, const Vec3& handle,
                   const force::OutputCommand& output);

// A trainee's perception of the nut in its hand.
struct Percept {
    double torque = 0.0;       // N·m, tightening positive
    double torque_rate = 0.0;  // N·m/s, smoothed over 30 ms
    bool yields = false;       // the slope of torque over angle has dropped: the bolt yields
    double nut_speed = 0.0;    // rad/s
    bool clicked = false;      // the torque wrench is swinging at its click
};

// Delays perception by a reaction time, and detects yielding from the slope of torque over the nut's angle.
// Values that the trainee sees, such as the nut's angle, have no delay.
class DelayedPerception {
  public:
    // `reaction`, `dt`: s. `stiffness`: wrench and wrist in series, N·m/rad; their deflection is subtracted
    // from the hand's rotation.
    DelayedPerception(double reaction, double dt, double stiffness);

    // Takes the values of one tick and returns the percept of a reaction time ago. `turned`: rotation of the
    // wrench by the hand, rad. `holds_nut`: the wrench or the fingers hold a nut.
    const Percept& update(double torque, double turned, double nut_speed, bool holds_nut,
                          bool clicked = false);

  private:
    struct Stimulus {
        double torque = 0.0, turned = 0.0, nut_speed = 0.0;
        bool holds_nut = false, clicked = false;
    };
    void update_slope(const Stimulus& delayed);

    double dt_, stiffness_;
    std::vector<Stimulus> delay_line_;  // ring buffer of one reaction time
    std::size_t next_ = 0;              // oldest entry of delay_line_
    Percept percept_;
    Stimulus slope_start_;   // at the start of the stretch over which the slope is measured; its `turned` is
                             // the nut's angle
    double steepest_ = 0.0;  // N·m/rad, since the nut was grasped
    double hand_angle_ = 0.0, nut_angle_ = 0.0;  // rad
    double hand_rate_ = 0.0, nut_rate_ = 0.0;    // rad per tick, smoothed
};

// Speed and accuracy of one kind of trainee. The values are plausible estimates of ours, not measurements. An
// instructor could observe each of them.
struct TraineeProfile {
    std::string_view name;     // for find_profile()
    double reach_time;         // s, from one joint to the next
    double placing_time;       // s, to lower the tool onto the nut
    double position_noise;     // m, standard deviation of the tool's position when placed
    double angle_noise;        // rad, standard deviation of the jaw's angle when placed
    double tremor;             // m, amplitude of physiological tremor (8–12 Hz)
    double tremor_torsion;     // rad, about the bolt while pulling
    double pull_speed;         // rad/s of the handle on a free nut
    double load_rate;          // 1/s, growth of the torque far from the goal, as a share of what is missing
    double final_rate;         // 1/s, growth of the torque at the goal, as a share of the goal
    double spin_speed;         // rad/s of the fingers
    double stroke;             // rad, longest pull before re-gripping
    double reaction;           // s from a stimulus to the response
    double torque_bias;        // relative, mean deviation of the intended torque from the target
    double torque_noise;       // relative, standard deviation of the intended torque
    double anticipation;       // 0…1, share of its own reaction time for which it compensates
    double feels_yield;        // probability of noticing that a bolt begins to yield
    double wanted_visibility;  // 0…1, visible fraction of nut and jaw that it seeks before the reach
    double pause;              // s, mean hesitation before a step
    double wrong_joint;        // probability of choosing another joint than the due one
    double stops_early;        // probability of stopping well below the target
    double overtightens;       // probability of pulling well past the target
    // Probability of forgetting the second wrench; it is then put on when nut and bolt have turned by 30°.
    double forgets_second_wrench;
    Impedance impedance{};
};

// Returns the profile of this name: "expert", "novice" or "clumsy". The error suggests the nearest name.
Result<TraineeProfile> find_profile(std::string_view name);
std::vector<std::string> profile_names();

}  // namespace bolt::trainees
