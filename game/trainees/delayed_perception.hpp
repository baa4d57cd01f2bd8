// A trainee's perception of the nut in its hand, delayed by a reaction time: the torque that the device
// renders, how that torque grows while the wrench turns, and the nut's motion. A trainee has no other access
// to the joint.
#pragma once

#include <vector>

#include "haptics/force/output_limits.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainees {

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

}  // namespace bolt::trainees
